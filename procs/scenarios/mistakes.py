"""Mistakes in scenario files, in words that say where they are and what would be right."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

import yaml
from pydantic import BaseModel, ValidationError

from procs.model.field import Point
from procs.model.robot import TEAM_NUMBERS, team_of
from procs.referee.orders import COMMANDS, TEAMS
from procs.simulation.physics.room import Room
from procs.simulation.simulator import SimulatorConfig


class UniqueKeys(yaml.SafeLoader):
    """Reads YAML and refuses a key that is given twice, of which PyYAML keeps the last alone."""

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        """Returns the value of a node.

        Raises:
            ConstructorError: the value is impossible, such as a date in a thirteenth month.
        """
        try:
            return super().construct_object(node, deep)
        except ValueError as error:
            raise yaml.constructor.ConstructorError(None, None, f"no such value: {error}", node.start_mark) from error

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict[Any, Any]:
        """Returns the values by their keys.

        Raises:
            ConstructorError: a key is given twice.
        """
        seen = set[str]()
        for key, _ in node.value:
            if isinstance(key, yaml.ScalarNode) and key.value in seen:
                raise yaml.constructor.ConstructorError(None, None, f"'{key.value}' is given twice", key.start_mark)
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")


def texts_of(error: ValidationError, where: str = "", known: Sequence[str] = ()) -> list[str]:
    """Returns one text for each mistake that pydantic found; `known` are the keys of the outermost level."""
    found = []
    for each in error.errors(include_url=False):
        path = [*([where] if where else []), *map(str, each["loc"])]
        if each["type"] == "extra_forbidden":
            found.append(": ".join(filter(None, (".".join(path[:-1]), _unknown(path[-1], known)))))
        else:
            found.append(f"{'.'.join(path)}: {each['msg'].removeprefix('Value error, ')}")
    return found


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
            found.append(f"{name} is {value!r}; it should be a {'number' if wanted is float else wanted.__name__}")
        elif wanted is float and not math.isfinite(value):
            found.append(f"{name} is {value!r}; it should be a finite number")
    return found


def robot_mistakes(robots: Sequence[str], dummies: Sequence[str], places: Mapping[str, Any]) -> Iterator[str]:
    """Yields what is wrong with the names of robots."""
    everyone = [*robots, *dummies]
    for name in dict.fromkeys(everyone):
        if not _NAME.fullmatch(name):
            yield f"robots: '{name}' is not a name; use letters, digits, '_' and '-', such as cyan1"
        if everyone.count(name) > 1:
            yield f"robots: '{name}' is named {everyone.count(name)} times"
    for name in places:
        if name not in everyone:
            yield f"places: no robot '{name}'; there are {', '.join(sorted(everyone)) or 'none'}"


def team_mistakes(robots: Sequence[str], settings: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Yields the robots that play for no team: neither their names nor the settings `players` say for which."""
    named = {name for values in settings.values() for name in values.get("players") or ()}
    for name in robots:
        if team_of(name) not in TEAM_NUMBERS and name not in named:
            yield f"robots: '{name}' plays for no team; names such as cyan1 and magenta2 tell it, or settings 'players'"


def command_mistakes(commands: Sequence[Any], everyone: Sequence[str], time_s: float) -> Iterator[str]:
    """Yields the actions that come too late, and those with a robot or a command of the referee that does not exist."""
    for place, action in enumerate(commands):
        if action.at_s >= time_s:
            yield f"commands.{place}: at_s is {action.at_s:g}; the scenario ends at {time_s:g} s"
        name = (action.referee or {}).get("name", "")
        if action.referee is not None and name not in COMMANDS:
            yield f"commands.{place}: referee: no command '{name}'; {right_name(name, COMMANDS)}"
        for kind, fields in (("place_robot", action.place_robot), ("referee", action.referee)):
            robot = (fields or {}).get("robot", "")
            if robot not in everyone and (robot or kind == "place_robot") and fields is not None:
                yield f"commands.{place}: {kind}: no robot '{robot}'; {right_name(robot, everyone)}"
        team = (action.referee or {}).get("team", "")
        if team not in TEAMS:
            yield f"commands.{place}: referee: no team '{team}'; {right_name(team, [each for each in TEAMS if each])}"


def place_mistakes(places: Mapping[str, Sequence[float]], config: SimulatorConfig) -> Iterator[str]:
    """Yields which robots would stand outside the walls, in a goal, or in each other."""
    starts = {name: Point(x_m, y_m) for name, (x_m, y_m, _) in places.items()}
    yield from (f"places: {each}" for each in Room(config.field).mistakes_in(starts, config.robot.radius_m))


def settings_mistakes(
    settings: Mapping[str, Mapping[str, Any]], configs: Mapping[str, type[BaseModel] | None]
) -> Iterator[str]:
    """Yields what is wrong with the settings of components; `configs` has the model of each component's settings."""
    for name, values in settings.items():
        if name not in configs:
            yield f"settings: no component '{name}'; {right_name(name, configs)}"
            continue
        model = configs[name]
        if model is None:
            if values:
                yield f"settings: {name} has no settings"
            continue
        try:
            model.model_validate(values)
        except ValidationError as error:
            yield from texts_of(error, name, list(model.model_fields))


def right_name(word: str, known: Iterable[str]) -> str:
    """Returns what would be right in the place of an unknown word: the nearest known word, or all of them."""
    names = list(known)
    near = get_close_matches(word, names, 1)
    return f"did you mean '{near[0]}'?" if near else f"there are {', '.join(names) or 'none'}"


def _unknown(key: str, known: Sequence[str]) -> str:
    near = get_close_matches(key, known, 1)
    return f"no key '{key}'" + (f"; did you mean '{near[0]}'?" if near else "")
