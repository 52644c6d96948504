"""Field crew of a scenario: sets robots and ball down, and gives the referee commands, each at its time."""

from typing import Annotated, Any, Self

from pydantic import AllowInfNan, BaseModel, ConfigDict, Field, NonNegativeFloat, model_validator

from fwk import Call, Calls, Clock, Component, Config, Logger, channel
from lcmtypes.soccer import place_ball_t, place_robot_t, referee_command_t
from procs.scenarios.mistakes import field_mistakes

_MESSAGES = {"place_ball": place_ball_t, "place_robot": place_robot_t, "referee": referee_command_t}


class Action(BaseModel):
    """Action of the crew; exactly one of the three is given."""

    model_config = ConfigDict(extra="forbid")

    at_s: Annotated[NonNegativeFloat, AllowInfNan(False)] = 0.0
    """Logical time, from the beginning of the run."""
    place_ball: dict[str, float] | None = None
    """Fields of `place_ball_t`: `x_m`, `y_m`, `vx_m_s` and so on."""
    place_robot: dict[str, Any] | None = None
    """Fields of `place_robot_t`: `robot`, `x_m`, `y_m`, `heading_rad`."""
    referee: dict[str, str] | None = None
    """Fields of `referee_command_t`: `name`, `team`, `robot`."""

    @model_validator(mode="after")
    def _makes_sense(self) -> Self:
        given = [name for name in _MESSAGES if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of {', '.join(_MESSAGES)}; here are {', '.join(given) or 'none'}")
        wrong = field_mistakes(getattr(self, given[0]), _MESSAGES[given[0]]())
        if wrong:
            raise ValueError(f"{given[0]}: {'; '.join(wrong)}")
        return self


class CrewConfig(Config):
    """Settings of the crew."""

    actions: list[Action] = Field([], frozen=True)
    """Actions in any order."""


class Crew(Component):
    """Carries out its actions in the order of their times."""

    stage = "sensor_acquire"

    config: CrewConfig
    clock: Clock
    log: Logger
    place_ball: Calls[place_ball_t] = channel("world/place_ball")
    place_robot: Calls[place_robot_t] = channel("world/place_robot")
    referee: Calls[referee_command_t] = channel("world/referee_command")

    def init(self) -> None:
        self._left = sorted(self.config.actions, key=lambda action: action.at_s)
        self._asked: list[tuple[Action, Call]] = []
        self.refused: list[str] = []
        """Actions that the simulator or the referee did not carry out, and why."""

    @property
    def unanswered(self) -> list[str]:
        """Actions that wait for their time, and how many have no answer yet."""
        late = [f"not given: the command at {each.at_s:g} s" for each in self._left]
        return late + ([f"without an answer: {len(self._asked)} commands"] if self._asked else [])

    def loop(self) -> None:
        while self._left and self._left[0].at_s * 1e6 <= self.clock.now_us:
            self._do(self._left.pop(0))
        for action, call in [each for each in self._asked if each[1].finished]:
            self._asked.remove((action, call))
            if not call.done:
                self.refused.append(f"refused: the command at {action.at_s:g} s: {call.reason}")
                self.log.error(self.refused[-1])

    def _do(self, action: Action) -> None:
        for port, fields in (
            (self.place_ball, action.place_ball),
            (self.place_robot, action.place_robot),
            (self.referee, action.referee),
        ):
            if fields is not None:
                port.value = type(port.value)()  # what an action does not name is not that of the one before
                for name, value in fields.items():
                    setattr(port.value, name, value)
                self._asked.append((action, port.call()))
