"""Mistakes in scenario files, in words that say where they are and what would be right.

A mistake begins with the path of its value: `commands.0: place_ball: ...`.
"""

import re
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from lcmtypes.soccer import place_ball_t
from procs.model.field import Field, Point
from procs.model.robot import PLAYERS, player_of, team_of
from procs.model.units import heading_mistake
from procs.referee.names import Names
from procs.referee.orders import mistake_in
from procs.scenarios.action import Action, field_mistakes
from procs.scenarios.scripted import Step, order_mistake
from procs.simulation.field_crew import ball_mistake, robot_mistake
from procs.simulation.physics.room import Room
from procs.simulation.simulator import SimulatorConfig

_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_DIGITS_MAX = 9


def robot_mistakes(named: Mapping[str, Collection[str]], places: Mapping[str, Any]) -> Iterator[str]:
    """Yields what is wrong with the names of robots; `named` holds those under each key of the file.

    A name that occurs again is a mistake of its last place.
    """
    paths = {name: path for path, name in _paths(named)}
    everyone = Counter(name for _, name in _paths(named))
    for name, times in everyone.items():
        path = paths[name]
        if not _NAME.fullmatch(name):
            yield f"{path}: '{name}' is not a name; use letters, digits, '_' and '-', such as cyan1"
        if _has_large_number(name):
            yield f"{path}: '{name}' has a number that is too large; use one of nine digits at most, such as cyan1"
        if times > 1:
            yield f"{path}: '{name}' is named {times} times"
    for name in places:
        if name not in everyone:
            yield f"places: no robot '{name}'; there are {', '.join(sorted(everyone)) or 'none'}"


def team_mistakes(named: Mapping[str, Sequence[str]], settings: Iterable[Mapping[str, Any]]) -> Iterator[str]:
    """Yields the robots that play for no team: neither their names nor `players` in any of the settings say for which.

    `named` holds the names under each key of the file.
    """
    stated = [players for values in settings if isinstance(players := values.get("players"), Mapping)]
    for path, name in _paths(named):
        if not (_has_large_number(name) or player_of(name, PLAYERS) or any(name in each for each in stated)):
            right = f"names such as cyan1 tell it, or rules: {{players: {{{name}: {{team: cyan, number: 1}}}}}}"
            yield f"{path}: '{name}' plays for no team; {right}"


def _has_large_number(name: str) -> bool:
    """Returns whether the number at the end of a name has more digits than numbers of robots may have."""
    return len(name[len(team_of(name)) :].lstrip("0")) > _DIGITS_MAX


def _paths(named: Mapping[str, Collection[str]]) -> Iterator[tuple[str, str]]:
    """Yields each robot after the path of its name: its place in a list, or the name itself where it is a key."""
    for key, names in named.items():
        for place, name in enumerate(names):
            yield f"{key}.{name if isinstance(names, Mapping) else place}", name


def script_mistakes(scripted: Mapping[str, Sequence[Step]], time_s: float) -> Iterator[str]:
    """Yields the steps of scripted robots that do not begin after the ones before, or only after the end."""
    for robot, steps in scripted.items():
        if mistake := order_mistake(steps):
            yield f"scripted.{robot}: {mistake}"
        for place, step in enumerate(steps):
            if step.at_s >= time_s:
                yield f"scripted.{robot}.{place}: at_s is {step.at_s:g}; the scenario ends at {time_s:g} s"


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
        wrong = [stranger] if (stranger := action.stranger(everyone)) else _refusals(action, everyone, config)
        yield from (f"commands.{place}: {action.kind}: {each}" for each in wrong if each)


def _refusals(action: Action, everyone: Sequence[str], config: SimulatorConfig) -> Iterator[str]:
    command = action.message
    if action.kind == "referee":
        yield mistake_in(command.name, command.team, command.robot, everyone, Names(config.players))
    elif action.kind == "place_robot":
        yield robot_mistake(command, everyone, config.field) or heading_mistake(command.heading_rad)
    elif action.kind == "place_ball":
        yield ball_mistake(command, config.field)


def simulator_settings(stated: Mapping[str, Any]) -> SimulatorConfig:
    """Returns the settings of the simulator that a scenario states; the usual ones if they have mistakes."""
    try:
        return SimulatorConfig.model_validate(stated)
    except ValidationError:
        return SimulatorConfig()


def place_mistakes(places: Mapping[str, Sequence[float]], config: SimulatorConfig) -> Iterator[str]:
    """Yields which robots would stand outside the walls, in a goal, or in each other."""
    for name, (_, _, heading_rad) in places.items():
        if mistake := heading_mistake(heading_rad):
            yield f"places.{name}: {mistake}"
    starts = {name: Point(x_m, y_m) for name, (x_m, y_m, _) in places.items()}
    yield from (f"places: {each}" for each in Room(config.field).mistakes_in(starts, config.robot.radius_m))
