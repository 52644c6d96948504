"""The kicker's hardware: takes commands after a delay, fires when it is charged, and charges again."""

import math
from typing import NamedTuple

import numpy as np

from procs.model.geometry import clamp
from procs.model.robot import RobotModel
from procs.simulation.physics.bodies import State
from procs.simulation.physics.delay import DelayLine
from procs.simulation.physics.mouth import Mouth
from procs.simulation.physics.realism import Noise, factor
from procs.simulation.physics.settings import KickerSettings


class KickerCommand(NamedTuple):
    """Command of the driver; a new `kick_id` with a speed above 0 is a new kick."""

    kick_id: int
    speed_m_s: float
    dribble: bool
    elevation_rad: float = 0.0
    """0: along the ground; otherwise a lob whose speed over the ground is `speed_m_s`."""


class Push(NamedTuple):
    """Effect of a kicker on the ball in a step."""

    change_m_s: tuple[float, float]
    """Change of the ball's velocity, world frame."""
    kicked: bool
    lift_m_s: float = 0.0
    """Vertical speed that a lob gives to the ball."""


class Kicker:
    """Kicker and ball handling of one robot. Without a ball in the mouth a kick has no effect."""

    def __init__(
        self, mouth: Mouth, robot: RobotModel, kicker: KickerSettings, noise: Noise, rng: np.random.Generator
    ) -> None:
        self.mouth = mouth
        self.kick_id = 0
        """Newest kick that was fired."""
        self._robot = robot
        self._settings = kicker
        self._noise = noise
        self._rng = rng
        self._line: DelayLine[KickerCommand] = DelayLine(round(noise.kick_delay_s * 1e6))
        self._dribble = False
        self._charged_from_us = 0
        self._handling_from_us = 0
        self._work_j = 0.0

    def command(self, command: KickerCommand, now_us: int) -> None:
        """Takes the newest command of the driver."""
        self._line.put(command, now_us)

    def drop_commands(self) -> None:
        """Drops the commands that have not taken effect yet."""
        self._line.clear()

    def begin_anew(self) -> None:
        """Drops the commands that have not taken effect yet, and is charged."""
        self._line.clear()
        self._charged_from_us = self._handling_from_us = 0

    def charged(self, now_us: int) -> bool:
        """Returns whether a kick is possible."""
        return now_us >= self._charged_from_us

    def act(self, now_us: int, duration_s: float, near: State | None) -> Push | None:
        """Handles or kicks the ball for one step; returns None without an effect on the ball.

        Args:
            now_us: logical time at the beginning of the step.
            duration_s: duration of the step.
            near: present state of the ball if it is not further away than `far_m` of the mouth; otherwise None.
        """
        push = None
        for command in self._line.due(now_us) if self._line.next_us <= now_us else ():
            self._dribble = command.dribble
            if command.speed_m_s > 0 and command.kick_id != self.kick_id and self.charged(now_us):
                self.kick_id = command.kick_id
                self._charged_from_us = now_us + round(self._settings.recharge_s * 1e6)
                self._handling_from_us = now_us + round(self._settings.release_s * 1e6)
                push = self._fire(command.speed_m_s, command.elevation_rad)
        if push is None and near is not None and self._dribble and now_us >= self._handling_from_us:
            place = self.mouth.place_of(near[0], near[1])
            if place is not None:
                push = Push(self.mouth.pull(place, near, duration_s), kicked=False)
        return push

    def charge(self, now_us: int) -> float:
        """Returns how much of the energy of a kick is there, 0..1."""
        missing_s = (self._charged_from_us - now_us) / 1e6
        return min(1.0, max(0.0, 1.0 - missing_s / self._settings.recharge_s))

    def take_work_j(self) -> float:
        """Returns the energy that kicks since the last call gave to the ball, or would have given to a resting one."""
        work_j, self._work_j = self._work_j, 0.0
        return work_j

    def _fire(self, speed_m_s: float, elevation_rad: float) -> Push | None:
        speed_error, direction_error = self._rng.standard_normal(2).tolist()
        speed_m_s = self._robot.kicked_m_s(speed_m_s, elevation_rad)
        self._work_j += self.mouth.ball_mass_kg * (speed_m_s / math.cos(elevation_rad)) ** 2 / 2
        if not self.mouth.holds_ball:
            return None
        speed_m_s *= factor(self._noise.kick_speed_sd, speed_error)
        error_rad = math.radians(self._noise.kick_direction_sd_deg) * direction_error
        error_rad = clamp(error_rad, -math.pi / 2, math.pi / 2)
        return Push(self.mouth.kick(speed_m_s, error_rad), kicked=True, lift_m_s=speed_m_s * math.tan(elevation_rad))
