"""A robot that drives and kicks by a script, to play what the rules forbid or to feed others the ball."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, NonNegativeFloat, Strict, model_validator

from fwk import Calls, Clock, Component, Config, Reads, Writes
from lcmtypes.robot import dribble_command_t, kick_command_t, kicker_state_t, motor_command_t
from procs.model.kicker import STEEPEST_RAD
from procs.model.units import US_PER_S

_Number = Annotated[FiniteFloat, Strict()]


class Step(BaseModel):
    """Step of a script; the robot does the same until the next one begins. Values that are not given are zero.

    A step lasts a tick at least: one that should begin in the same tick as the step before begins in the next.
    """

    model_config = ConfigDict(extra="forbid")

    at_s: Annotated[NonNegativeFloat, Strict()] = 0.0
    """Logical time at which the step begins."""
    vx_m_s: _Number = 0.0
    """Velocity ahead, within the limits of the robot's driver."""
    vy_m_s: _Number = 0.0
    """Velocity to the left."""
    omega_rad_s: _Number = 0.0
    """Turning speed, counter-clockwise."""
    dribble: Annotated[bool, Strict()] = False
    """Whether the ball handling is on."""
    kick_m_s: Annotated[FiniteFloat, Field(ge=0.0), Strict()] = 0.0
    """Speed over the ground of one kick, as soon as the robot holds the ball and is charged; 0: none."""
    elevation_rad: Annotated[float, Field(ge=0.0, le=STEEPEST_RAD), Strict()] = 0.0
    """Elevation of the kick."""


class ScriptConfig(Config):
    """Settings of a scripted robot."""

    steps: list[Step] = Field([], frozen=True)
    """Steps in the order of their times; before the first one the robot stands."""

    @model_validator(mode="after")
    def _follow(self) -> Self:
        if mistake := order_mistake(self.steps):
            raise ValueError(mistake)
        return self


def order_mistake(steps: Sequence[Step]) -> str:
    """Returns which step of a script does not begin after the one before; empty if all do."""
    for place, (step, following) in enumerate(pairwise(steps), start=1):
        if following.at_s <= step.at_s:
            return f"step {place} begins at {following.at_s:g} s; it should begin after {step.at_s:g} s"
    return ""


class Script(Component):
    """Carries out the steps of a script with the drivers of wheels and kicker, without regard to the game."""

    stage = "act"

    config: ScriptConfig
    clock: Clock
    kicker_state: Reads[kicker_state_t]
    motor_command: Writes[motor_command_t]
    dribble_command: Writes[dribble_command_t]
    kick: Calls[kick_command_t]

    def init(self) -> None:
        self._left = list(self.config.steps)
        self._step = Step()
        self._kicks = 0  # that the robot had carried out when the step began

    def loop(self) -> None:
        kicker = self.kicker_state.value
        if self._left and self._left[0].at_s * US_PER_S <= self.clock.now_us:
            self._step, self._kicks = self._left.pop(0), kicker.kicks
        step, command = self._step, self.motor_command.value
        command.enabled = True
        command.vx_m_s, command.vy_m_s, command.omega_rad_s = step.vx_m_s, step.vy_m_s, step.omega_rad_s
        self.motor_command.write()
        self.dribble_command.value.on = step.dribble
        self.dribble_command.write()
        if step.kick_m_s and kicker.kicks == self._kicks and kicker.ball_held and kicker.charged:
            self.kick.value.speed_m_s, self.kick.value.elevation_rad = step.kick_m_s, step.elevation_rad
            self.kick.call(expires_s=0.0)
