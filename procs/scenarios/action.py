"""Action of a field crew: one command to the simulator or the referee, at its time."""

import math
from collections.abc import Collection, Mapping
from typing import Annotated, Any, Self

from pydantic import AllowInfNan, BaseModel, ConfigDict, Field, Strict, model_validator

from lcmtypes.soccer import (
    freeze_world_t,
    hold_robot_t,
    place_ball_t,
    place_robot_t,
    referee_command_t,
    reset_world_t,
)
from procs.model.right_name import right_name

MESSAGES: Mapping[str, type[Any]] = {
    "place_ball": place_ball_t,
    "place_robot": place_robot_t,
    "hold_robot": hold_robot_t,
    "freeze": freeze_world_t,
    "reset": reset_world_t,
    "referee": referee_command_t,
}
"""Commands by their names in scenarios, and their types."""
_KINDS = {float: "a number", bool: "true or false", str: "a text"}
"""Types of the commands' fields, in words."""


class Action(BaseModel):
    """Action of the crew; exactly one command is given."""

    model_config = ConfigDict(extra="forbid")

    at_s: Annotated[float, Field(ge=0.0), AllowInfNan(False), Strict()] = 0.0
    """Logical time, from the beginning of the scenario."""
    place_ball: dict[str, float] | None = None
    """Fields of `place_ball_t`: `x_m`, `y_m`, `vx_m_s` and so on."""
    place_robot: dict[str, Any] | None = None
    """Fields of `place_robot_t`: `robot`, `x_m`, `y_m`, `heading_rad`."""
    hold_robot: dict[str, Any] | None = None
    """Fields of `hold_robot_t`: `robot`, `held`."""
    freeze: dict[str, Any] | None = None
    """Field of `freeze_world_t`: `frozen`."""
    reset: dict[str, Any] | None = None
    """Field of `reset_world_t`: `keep_ball`; `{}` puts the ball on the centre."""
    referee: dict[str, str] | None = None
    """Fields of `referee_command_t`: `name`, `team`, `robot`."""

    @model_validator(mode="after")
    def _makes_sense(self) -> Self:
        given = [name for name in MESSAGES if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give one of {', '.join(MESSAGES)}; here are {', '.join(given) or 'none'}")
        wrong = field_mistakes(self.fields, MESSAGES[self.kind]())
        for kind, field in (("freeze", "frozen"), ("hold_robot", "held")):
            if self.kind == kind and field not in self.fields:
                wrong.append(f"{field} is missing; it should be true or false")
        if wrong:
            raise ValueError(f"{self.kind}: {'; '.join(wrong)}")
        return self

    @property
    def kind(self) -> str:
        """Name of the command."""
        return next(name for name in MESSAGES if getattr(self, name) is not None)

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of the command."""
        return dict(getattr(self, self.kind))

    @property
    def message(self) -> Any:
        """The command; fields that are not given are zero."""
        made = MESSAGES[self.kind]()
        for name, value in self.fields.items():
            setattr(made, name, value)
        return made

    def stranger(self, robots: Collection[str]) -> str:
        """Returns what is wrong with the robot of the command if it is none of `robots`; otherwise an empty text."""
        command = self.message
        robot = command.robot if "robot" in command.__slots__ else None
        if robot is None or robot in robots or (self.kind == "referee" and not robot):
            return ""
        return f"no robot '{robot}'; {right_name(robot, robots)}"


def field_mistakes(fields: Mapping[str, Any], message: Any) -> list[str]:
    """Returns what is wrong with fields that are given for a message: unknown names, and values of another type."""
    known = [name for name in message.__slots__ if name not in ("header", "command")]
    found = []
    for name, value in fields.items():
        if name not in known:
            found.append(f"there is no '{name}'; there are {', '.join(known)}")
            continue
        wanted = type(getattr(message, name))
        fits = isinstance(value, (int, float)) if wanted is float else isinstance(value, wanted)
        if not fits or (isinstance(value, bool) and wanted is not bool):
            found.append(f"{name} is {value!r}; it should be {_KINDS[wanted]}")
        elif wanted is float and not math.isfinite(value):
            found.append(f"{name} is {value!r}; it should be a finite number")
    return found
