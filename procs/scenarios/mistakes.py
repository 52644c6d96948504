"""Mistakes in scenario files, in words that say where they are and what would be right."""

import re
from collections.abc import Iterator, Mapping, Sequence
from difflib import get_close_matches
from typing import Any

import yaml
from pydantic import BaseModel, ValidationError

from lcmtypes.soccer import place_ball_t
from procs.model.field import Field, Point
from procs.model.right_name import right_name
from procs.model.robot import PLAYERS, player_of
from procs.referee.names import Names
from procs.referee.orders import mistake_in
from procs.scenarios.action import Action, field_mistakes
from procs.simulation.field_crew import ball_mistake, robot_mistake
from procs.simulation.physics.room import Room
from procs.simulation.simulator import SimulatorConfig

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_LARGE_NUMBER = re.compile(r".*?0*[1-9]\d{9,}")


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


def texts_of(error: ValidationError, where: str = "", known: Sequence[str] = ()) -> list[str]:
    """Returns one text for each mistake that pydantic found; `known` are the keys of the outermost level."""
    found = []
    for each in error.errors(include_url=False):
        path = [*([where] if where else []), *map(str, each["loc"])]
        if each["type"] == "extra_forbidden":
            found.append(": ".join(filter(None, (".".join(path[:-1]), _unknown(path[-1], known)))))
        elif each["type"] == "missing":
            found.append(": ".join(filter(None, (".".join(path[:-1]), f"{path[-1]} is missing"))))
        else:
            found.append(f"{'.'.join(path)}: {each['msg'].removeprefix('Value error, ')}")
    return found


def robot_mistakes(robots: Sequence[str], dummies: Sequence[str], places: Mapping[str, Any]) -> Iterator[str]:
    """Yields what is wrong with the names of robots."""
    everyone = [*robots, *dummies]
    for name in dict.fromkeys(everyone):
        if not _NAME.fullmatch(name):
            yield f"robots: '{name}' is not a name; use letters, digits, '_' and '-', such as cyan1"
        if _LARGE_NUMBER.fullmatch(name):
            yield f"robots: '{name}' has a number that is too large; use one of nine digits at most, such as cyan1"
        if everyone.count(name) > 1:
            yield f"robots: '{name}' is named {everyone.count(name)} times"
    for name in places:
        if name not in everyone:
            yield f"places: no robot '{name}'; there are {', '.join(sorted(everyone)) or 'none'}"


def team_mistakes(robots: Sequence[str], settings: Mapping[str, Mapping[str, Any]]) -> Iterator[str]:
    """Yields the robots that play for no team: neither their names nor the settings `players` say for which."""
    stated = [players for values in settings.values() if isinstance(players := values.get("players"), Mapping)]
    for name in robots:
        if not (_LARGE_NUMBER.fullmatch(name) or player_of(name, PLAYERS) or any(name in each for each in stated)):
            yield f"robots: '{name}' plays for no team; names such as cyan1 and magenta2 tell it, or settings 'players'"


def ball_mistakes(fields: Mapping[str, Any], field: Field) -> Iterator[str]:
    """Yields why the ball of a scenario cannot be put to its place."""
    wrong = field_mistakes(fields, place_ball_t()) or [ball_mistake(place_ball_t(**fields), field)]
    yield from (f"ball: {each}" for each in wrong if each)


def command_mistakes(
    commands: Sequence[Action], everyone: Sequence[str], time_s: float, config: SimulatorConfig
) -> Iterator[str]:
    """Yields the actions that come too late, and those that simulator or referee would refuse at any time."""
    for place, action in enumerate(commands):
        if action.at_s >= time_s:
            yield f"commands.{place}: at_s is {action.at_s:g}; the scenario ends at {time_s:g} s"
        yield from (f"commands.{place}: {action.kind}: {each}" for each in _refusals(action, everyone, config) if each)


def _refusals(action: Action, everyone: Sequence[str], config: SimulatorConfig) -> Iterator[str]:
    command = action.message
    robot = command.robot if "robot" in command.__slots__ else ""
    if "robot" in command.__slots__ and robot not in everyone and (robot or action.kind != "referee"):
        yield f"no robot '{robot}'; {right_name(robot, everyone)}"
    elif action.kind == "referee":
        yield mistake_in(command.name, command.team, robot, everyone, Names(config.players))
    elif action.kind == "place_robot":
        yield robot_mistake(command, everyone, config.field)
    elif action.kind == "place_ball":
        yield ball_mistake(command, config.field)


def simulator_settings(settings: Mapping[str, Mapping[str, Any]]) -> SimulatorConfig:
    """Returns the settings of the simulator that a scenario states; the usual ones if they have mistakes."""
    try:
        return SimulatorConfig.model_validate(settings.get("world/simulator", {}))
    except ValidationError:
        return SimulatorConfig()


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


def _unknown(key: str, known: Sequence[str]) -> str:
    near = get_close_matches(key, known, 1)
    return f"no key '{key}'" + (f"; did you mean '{near[0]}'?" if near else "")
