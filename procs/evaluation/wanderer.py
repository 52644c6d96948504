"""Drives a robot to random places of the field, and carries it away now and then; the robot is not told."""

import math

import numpy as np
from pydantic import Field as Setting

from fwk import Calls, Clock, Component, Config, Reads, Writes, channel
from lcmtypes.robot import motor_command_t
from lcmtypes.soccer import ground_truth_t, place_robot_t
from procs.model.field import Field, MatchField
from procs.model.frames import rotation

_INSIDE_M = 0.7  # robots drive to places so far inside the lines
_THERE_M = 0.5


class WandererConfig(Config):
    """Settings of the trial."""

    carried_every_s: float = Setting(default=12.0, ge=0.0)
    """Time from one kidnapping to the next; 0: no robot is kidnapped."""
    carried_inside_m: float = Setting(default=0.7, ge=-2.0, le=3.0)
    """Robots are put down at least so far inside the lines; below 0 beyond them, too, where there is room."""
    speed_m_s: float = Setting(default=1.5, ge=0.0, le=3.0)
    """Speed of driving."""
    turn_rad_s: float = Setting(default=1.5, ge=0.0, le=4.0)
    """Highest speed of turning."""
    field: MatchField = Field()
    """Measures of the field."""


class Wanderer(Component):
    """Stands in for everything that decides; knows the truth."""

    stage = "act"

    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    motor_command: Writes[motor_command_t]
    place_robot: Calls[place_robot_t] = channel("world/place_robot")
    config: WandererConfig
    clock: Clock
    rng: np.random.Generator

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._carried_us = 0
        self._target = self._drawn()

    def loop(self) -> None:
        period_s = self.config.carried_every_s
        if period_s and self.clock.since_s(self._carried_us) >= period_s:
            self._carry()
        own = next((each for each in self.ground_truth.value.robots if each.name == self._robot), None)
        if own is None:
            return
        way_m = self._target[:2] - (own.x_m, own.y_m)
        away_m = float(np.hypot(*way_m))
        if away_m < _THERE_M:
            self._target = self._drawn()
        command = self.motor_command.value
        velocity_m_s = rotation(-own.heading_rad) @ way_m * (self.config.speed_m_s / max(away_m, _THERE_M))
        command.vx_m_s, command.vy_m_s = velocity_m_s.tolist()
        command.omega_rad_s = float(self._target[2]) / math.pi * self.config.turn_rad_s
        command.enabled = True
        self.motor_command.write()

    def _carry(self) -> None:
        self._carried_us = self.clock.now_us
        place = self.place_robot.value
        place.robot = self._robot
        place.x_m, place.y_m, place.heading_rad = self._drawn(self.config.carried_inside_m).tolist()
        self.place_robot.call()
        self._target = self._drawn()

    def _drawn(self, inside_m: float = _INSIDE_M) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        """Returns a random pose (3) on the field, at least so far inside its lines."""
        field = self.config.field
        limits = (field.half_length_m - inside_m, field.half_width_m - inside_m, math.pi)
        return np.asarray(self.rng.uniform(-1.0, 1.0, 3) * limits)
