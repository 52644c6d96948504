"""Words of soccer in the conditions of scenarios: `ball`, `play`, `distance(cyan2, ball)`, `x(magenta1)` ..."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping
from numbers import Real
from typing import Any

from fwk.testing import reads_messages
from lcmtypes.soccer import game_event_t, game_state_t
from procs.model.events import Kind
from procs.model.field import Point
from procs.model.right_name import right_name
from procs.referee.reasons import Reason

Newest = Callable[[str], Any]

_NAMES = {name.lower(): value for name, value in vars(game_state_t).items() if name.isupper()}
_TEAMS = {name.removeprefix("team_"): value for name, value in _NAMES.items() if name in ("team_cyan", "team_magenta")}
_STATES = {name: value for name, value in _NAMES.items() if not name.startswith("team_")}


_CARDS = {game_event_t.YELLOW: "yellow", game_event_t.DOUBLE_YELLOW: "double_yellow", game_event_t.RED: "red"}


@reads_messages
def _ball(newest: Newest) -> Point:
    truth = newest("world/ground_truth")
    return Point(truth.ball_x_m, truth.ball_y_m)


@reads_messages
def _ball_speed(newest: Newest) -> float:
    truth = newest("world/ground_truth")
    return math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s)


@reads_messages
def _distance(newest: Newest) -> Callable[[Any, Any], float]:
    def distance(one: Any, two: Any) -> float:
        """Returns the distance of two places in m."""
        return math.dist(_place(newest, one), _place(newest, two))

    return distance


@reads_messages
def _state(newest: Newest) -> Callable[..., bool]:
    def state(name: str, team: str = "") -> bool:
        """Returns whether the game is in a state, for a team if one is named."""
        game = newest("world/game_state")
        wanted, of = _named(_STATES, "state", str(name)), _named(_TEAMS, "team", str(team)) if team else game.state_team
        return bool(game.state == wanted and game.state_team == of)

    return state


def _named(table: Mapping[str, int], kind: str, name: str) -> int:
    if name not in table:
        raise KeyError(f"no {kind} '{name}'; {right_name(name, table)}")
    return table[name]


def _place(newest: Newest, what: Any) -> Point:
    """Returns a place: a point, or that of a robot by its name."""
    if isinstance(what, tuple) and len(what) == 2 and all(isinstance(each, Real) for each in what):
        return Point(*what)
    if callable(what) or isinstance(what, (Real, tuple, list)):
        raise TypeError("a place is the ball, a robot by its name, or two numbers as in (1.0, -2.0)")
    robots = newest("world/ground_truth").robots
    for robot in robots:
        if robot.name == str(what):
            return Point(robot.x_m, robot.y_m)
    raise KeyError(f"no robot '{what}'; {right_name(str(what), [robot.name for robot in robots])}")


class _Names(list[str]):
    """Names of one kind, of which all are known: a condition about another name is a mistake."""

    def __init__(self, names: Iterable[str], kind: str, known: Collection[str]) -> None:
        super().__init__(names)
        self._kind = kind
        self._known = known

    def __contains__(self, name: object) -> bool:
        if name not in self._known:
            raise KeyError(f"no {self._kind} '{name}'; {right_name(str(name), self._known)}")
        return super().__contains__(name)


@reads_messages
def _reasons(newest: Newest) -> list[str]:
    given = [event.reason for event in newest("world/match_history").events if event.reason]
    return _Names(given, "reason", list(map(str, Reason)))


@reads_messages
def _cards(newest: Newest) -> Callable[[str], list[str]]:
    def cards(robot: str) -> list[str]:
        """Returns the cards of a robot so far, in their order."""
        robots = [each.name for each in newest("world/ground_truth").robots]
        if str(robot) not in robots:
            raise KeyError(f"no robot '{robot}'; {right_name(str(robot), robots)}")
        shown = (event for event in newest("world/match_history").events if event.robot == str(robot))
        return _Names([_CARDS[event.card] for event in shown if event.card], "card", list(_CARDS.values()))

    return cards


@reads_messages
def _touches(newest: Newest) -> list[str]:
    names = [event.robot for event in newest("world/match_events").events if event.kind in (Kind.TOUCH, Kind.KICK)]
    return _Names(names, "robot", [robot.name for robot in newest("world/ground_truth").robots])


@reads_messages
def _events(newest: Newest) -> list[str]:
    names = [Kind(event.kind).name.lower() for event in newest("world/match_events").events]
    return _Names(names, "event", [kind.name.lower() for kind in Kind])


@reads_messages
def _hardest(newest: Newest) -> float:
    speeds_m_s = (each.speed_m_s for each in newest("world/match_events").events if each.kind == Kind.COLLISION)
    return max(speeds_m_s, default=0.0)


def _axis(axis: int) -> Callable[[Newest], Callable[[Any], float]]:
    return reads_messages(lambda newest: lambda place: _place(newest, place)[axis])


WORDS: Mapping[str, Callable[..., Any]] = {
    "ball": _ball,
    "ball_speed": _ball_speed,
    "distance": _distance,
    "state": _state,
    "reasons": _reasons,
    "cards": _cards,
    "x": _axis(0),
    "y": _axis(1),
    "touching": _touches,
    "events": _events,
    "collision": _hardest,
}
"""`ball` is a place and `ball_speed` a number in m/s; `reasons` are those of all whistles, `cards("cyan2")` those of a
robot, such as "yellow"; `touching` are the robots at the ball, `events` what happens, such as "goal" or "out_end", and
`collision` the closing speed, 0 without one, all in this tick; `state("free_kick", "cyan")`. A ball in the goal is a
"goal" also if it does not count."""
