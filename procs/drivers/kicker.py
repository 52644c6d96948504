"""Driver of the kicker: kicks once the robot has the ball and the kicker is charged, and switches ball handling."""

from collections import deque
from typing import NamedTuple

from pydantic import PositiveFloat

from fwk import Clock, Component, Config, Logger, Reads, Request, Serves, Writes
from lcmtypes.robot import dribble_command_t, kick_command_t, kicker_drive_t, kicker_sensor_t, kicker_state_t
from procs.drivers.silence import Silence
from procs.model.geometry import BOUND, clamp, plausible
from procs.model.kicker import STEEPEST_RAD
from procs.model.robot import ROBOT, RobotModel

_KICKS_MAX = 2**31 - 1
"""Kicks are numbered from 1 to this number, then from 1 again."""
_UNDER_WAY_MAX = 8
"""Most kicks that may be under way to the hardware; older ones are forgotten."""


class _Asked(NamedTuple):
    """Kick that the hardware was told to carry out."""

    kick_id: int
    speed_m_s: float
    elevation_rad: float


class KickerConfig(Config):
    """Settings of the kicker's driver."""

    robot: RobotModel = ROBOT
    """Geometry of the robot, and the highest speed of its kicks."""
    command_timeout_s: PositiveFloat = 0.25
    """Ball handling stops when the newest dribble command is older than this. A kick that the hardware has not carried
    out within this time has failed."""


class Kicker(Component):
    """Publishes the state of the kicker when sensors are read, and its drive when actuators act.

    A kick waits for ball and charge until it expires; a kick without a speed is rejected at once. A kick is accepted
    when the hardware is told to kick, and done when the hardware has kicked. Kicks that this driver did not ask for,
    such as those before a restart, do not count, because their speed is unknown. Hardware that falls silent holds no
    ball and is not charged.
    """

    stage = ("sensor_acquire", "act_exec")

    kicker_sensor: Reads[kicker_sensor_t]
    kick: Serves[kick_command_t]
    dribble_command: Reads[dribble_command_t]
    kicker_state: Writes[kicker_state_t]
    kicker_drive: Writes[kicker_drive_t]
    config: KickerConfig
    clock: Clock
    log: Logger

    def init(self) -> None:
        self._kicks = 0
        self._under_way: deque[_Asked] = deque(maxlen=_UNDER_WAY_MAX)  # not carried out yet, oldest first
        self._asked_us = 0  # when the hardware was told the newest kick
        self._late = False
        self._silence = Silence(
            "no reading of the kicker for {silent_s:.2f} s: no ball is held, and no kick possible", self.log.warning
        )

    def loop(self) -> None:
        for sensor in self.kicker_sensor.fresh:
            self._silence.end(self.clock)
            if any(asked.kick_id == sensor.kick_id for asked in self._under_way):
                self._kicked(sensor.kick_id)
            self.kicker_state.value.kick_id = sensor.kick_id
        self._silence.go_on(self.clock)
        if self.clock.stage == "act_exec":
            self._act()
        else:
            self._report()

    def finalize(self) -> None:
        """Switches ball handling off and leaves no kick waiting."""
        self.kicker_drive.value = kicker_drive_t()
        self.kicker_drive.value.kick_id = self.kicker_sensor.value.kick_id
        self.kicker_drive.write()

    def _kicked(self, kick_id: int) -> None:
        """Counts a kick that was under way; the hardware has skipped the kicks before it."""
        while (asked := self._under_way.popleft()).kick_id != kick_id:
            pass
        self._kicks += 1
        state = self.kicker_state.value
        state.kick_speed_m_s, state.kick_elevation_rad = asked.speed_m_s, asked.elevation_rad
        if not self._under_way:
            for request in self.kick.open:
                request.done()

    def _report(self) -> None:
        state, sensor, known = self.kicker_state.value, self.kicker_sensor.value, not self._silence.is_long
        state.ball_held, state.charged, state.kicks = known and sensor.ball_held, known and sensor.charged, self._kicks
        state.charge = sensor.charge if known else 0.0
        state.capture_us = sensor.capture_us or sensor.header.time_us
        self.kicker_state.write()
        if self.clock.since_s(self._asked_us) > self.config.command_timeout_s:
            self._fail_open("the hardware has not kicked")

    def _act(self) -> None:
        """Commands the hardware: the next waiting kick if ball and charge are there, and ball handling."""
        self._refuse_impossible()
        sensor, drive = self.kicker_sensor.value, self.kicker_drive.value
        drive.kick_id, drive.kick_m_s, drive.elevation_rad = sensor.kick_id, 0.0, 0.0
        ready = sensor.ball_held and sensor.charged and not self._silence.is_long
        if ready and (request := self.kick.take()):
            self._fail_open("a newer kick replaced it", spared=request)
            request.accept()
            newest_id = self._under_way[-1].kick_id if self._under_way else sensor.kick_id
            drive.kick_id = newest_id % _KICKS_MAX + 1
            drive.elevation_rad = clamp(request.value.elevation_rad, 0.0, STEEPEST_RAD)
            drive.kick_m_s = self.config.robot.kicked_m_s(request.value.speed_m_s, drive.elevation_rad)
            self._under_way.append(_Asked(drive.kick_id, drive.kick_m_s, drive.elevation_rad))
            self._asked_us = self.clock.now_us
        drive.dribble = self._is_fresh() and self.dribble_command.value.on
        self.kicker_drive.write()

    def _refuse_impossible(self) -> None:
        """Rejects waiting kicks with an impossible speed or elevation."""
        for request in self.kick.waiting:
            speed_m_s, elevation_rad = request.value.speed_m_s, request.value.elevation_rad
            if not 0.0 < speed_m_s < BOUND:
                request.reject(f"speed_m_s is {speed_m_s}; it should be above 0 and below {BOUND:g}")
            elif not plausible(elevation_rad):
                request.reject(f"elevation_rad is {elevation_rad}; it should be from 0 to pi/3")

    def _fail_open(self, reason: str, spared: Request[kick_command_t] | None = None) -> None:
        """Fails all accepted kicks except `spared`."""
        for request in self.kick.open:
            if request is not spared:
                request.fail(reason)

    def _is_fresh(self) -> bool:
        """Returns whether the newest dribble command still counts; reports the first tick in which it does not."""
        age_s = self.clock.since_s(self.dribble_command.header.time_us)
        late = self.dribble_command.has_value and age_s > self.config.command_timeout_s
        if late and not self._late:
            self.log.warning(f"no dribble command for {age_s:.2f} s: ball handling stops")
        self._late = late
        return self.dribble_command.has_value and not late
