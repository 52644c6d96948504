"""Matches by chance: the referee favours no team, goes on after a restart from any tick, and never gets stuck."""

import random
from collections.abc import Iterator
from typing import Any

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.cards import Card
from procs.referee.memory import recall, written
from procs.referee.orders import COMMANDS, carry_out
from procs.referee.reasons import Reason
from procs.referee.rules import Rules
from procs.referee.sight import Sight
from procs.referee.whistle import Whistle
from tests.procs.referee.script import TICK_S

NAMES = [f"{team}{number}" for team in ("cyan", "magenta") for number in range(1, 6)]
TIMES = {"half_s": 30.0, "half_time_s": 0.5, "overtime_half_s": 5.0, "stoppage_s": 0.3, "kick_off_stoppage_s": 0.3}
TIMES |= {"positions_s": 1.0, "ends_s": 1.0, "deadlock_s": 5.0, "penalty_s": 3.0, "shot_s": 5.0}
TIMES |= {"repair_s": 2.0, "double_yellow_s": 5.0}
PLACES = {Kind.GOAL: (11.2, 0.5), Kind.OUT_END: (11.2, 4.0), Kind.OUT_SIDE: (5.0, 7.2)}


class Chance:
    """Ten robots and a ball that move by chance; robots of a pair at times drive one another."""

    def __init__(self, seed: int, whistle: Whistle) -> None:
        self._random, self.whistle = random.Random(seed), whistle
        self._robots = {name: Point(0.0, 0.0) for name in NAMES}
        self._velocities = dict(self._robots)
        self._ball, self._last, self._placed = Point(0.0, 0.0), "", 0

    def sight(self) -> Sight:
        """Returns the sight of the next tick."""
        chance, whistle = self._random, self.whistle
        if self._placed != whistle.placements:
            self._placed, self._ball = whistle.placements, whistle.spot
            self._line_up()
        for name, velocity in self._velocities.items():
            place = self._robots[name]
            moved = (place.x_m + TICK_S * velocity.x_m, place.y_m + TICK_S * velocity.y_m)
            self._robots[name] = Point(
                *(max(-limit, min(limit, each)) for each, limit in zip(moved, (11.4, 7.5), strict=True))
            )
        if chance.random() < 0.05:
            self._drive()
        if chance.random() < 0.4:
            self._ball = Point(*(each + chance.gauss(0.0, 0.4) for each in self._ball))
        events = list(self._events())
        return Sight(self._ball, events, dict(self._robots), dict(self._velocities), self._last)

    def _line_up(self) -> None:
        for number, name in enumerate(NAMES):
            side = self.whistle.ends.side_of(Team.CYAN if name.startswith("cyan") else Team.MAGENTA)
            keeps = name.endswith("1")
            self._robots[name] = Point(side * (10.7 if keeps else 6.0), 0.0 if keeps else -5.0 + number)
            self._velocities[name] = Point(0.0, 0.0)

    def _drive(self) -> None:
        """Lets a robot drive another for a while, or into the goal; at times two pairs, mirrored."""
        chance = self._random
        first, second = chance.sample(NAMES, 2)
        speed_m_s, start = chance.uniform(-1.0, 1.0), Point(chance.uniform(-11.3, 11.3), chance.uniform(-6.0, 6.0))
        self._put({first: start, second: Point(start.x_m + 0.5 * (1 if speed_m_s > 0 else -1), start.y_m)}, speed_m_s)
        if chance.random() < 0.5:
            pair = {exchanged(name): turned(self._robots[name]) for name in (first, second)}
            if not {first, second} & set(pair):
                self._put(pair, -speed_m_s)

    def _put(self, pair: dict[str, Point], speed_m_s: float) -> None:
        self._robots |= pair
        self._velocities |= dict.fromkeys(pair, Point(speed_m_s, 0.0))

    def _events(self) -> Iterator[Event]:
        chance = self._random
        for robot in chance.sample(NAMES, chance.choice((0, 0, 0, 1, 1, 2))):
            self._last = robot
            yield Event(chance.choice((Kind.TOUCH, Kind.TOUCH, Kind.KICK)), robot, "", *self._ball, 1.0)
        for _ in range(chance.choice((0,) * 30 + (1, 2))):
            robot, other = chance.sample(NAMES, 2)
            yield Event(Kind.COLLISION, robot, other, *self._robots[robot], chance.uniform(1.0, 5.0))
        if not self.whistle.stopped and chance.random() < 0.03:
            kind, side = chance.choice(list(PLACES)), chance.choice((-1.0, 1.0))
            self._ball = Point(side * PLACES[kind][0], PLACES[kind][1])
            yield Event(kind, self._last, "", *self._ball, 3.0)


def exchanged(robot: str) -> str:
    """Returns the robot of the same number in the other team, or the other team."""
    team, number = robot.rstrip("0123456789"), robot.lstrip("acegimnty")
    return robot and ("magenta" if team == "cyan" else "cyan") + number


def turned(place: tuple[float, float]) -> Point:
    """Returns a place after half a turn about the centre."""
    return Point(-place[0], -place[1])


def other_side(sight: Sight) -> Sight:
    """Returns the sight of the same tick in which the teams have changed places."""
    return Sight(
        turned(sight.ball),
        [
            Event(each.kind, exchanged(each.robot), exchanged(each.other), *turned(each[3:5]), each[5])
            for each in sight.events
        ],
        {exchanged(name): turned(place) for name, place in sight.robots.items()},
        {exchanged(name): turned(velocity) for name, velocity in sight.velocities_m_s.items()},
        exchanged(sight.last_touch),
    )


def stand(whistle: Whistle, mirrored: bool) -> tuple[Any, ...]:
    """Returns how a match stands, and the decisions of the tick in any order; `mirrored`: with the teams exchanged."""
    named = exchanged if mirrored else str

    def team(given: Team) -> Team:
        return given.other if mirrored else given

    spot = turned(whistle.spot) if mirrored else whistle.spot
    calls = sorted(
        (each.state, team(each.team), named(each.robot), str(each.reason), each.card, each.goal)
        for each in whistle.calls
    )
    score = [whistle.score[team(each)] for each in (Team.CYAN, Team.MAGENTA)]
    cards = [sorted(map(named, robots)) for robots in (whistle.cards.sent_off, whistle.cards.warned)]
    place = (spot.x_m + 0.0, spot.y_m + 0.0)  # no negative zero
    return whistle.state, team(whistle.team), whistle.stopped, whistle.half, place, score, cards, calls


@pytest.mark.parametrize("seed", range(4))
def test_random_match_is_the_same_with_exchanged_teams(seed: int) -> None:
    rules = TIMES | {"fouls_per_card": 1 + seed % 3, "decide": True}
    ours, theirs = Whistle(Rules(**rules)), Whistle(Rules(**rules, first_kick_off="magenta"))
    chance, states, quiet_s = Chance(seed, ours), set(), 0.0
    for tick in range(3000):
        sight = chance.sight()
        if tick % 50 == 25:  # the referee is restarted
            ours = chance.whistle = restarted(ours)
        if tick % 400 == 300:
            robot = NAMES[(seed + tick // 400) % 10]
            for whistle, name in ((ours, robot), (theirs, exchanged(robot))):
                whistle.take_out(name, Reason.REPAIR) if seed % 2 else whistle.card(name, Card.DOUBLE_YELLOW)
        ours.step(TICK_S, sight)
        theirs.step(TICK_S, other_side(sight))
        assert stand(ours, mirrored=True) == stand(theirs, mirrored=False), f"tick {tick}: {sight.events}"
        quiet_s = 0.0 if ours.calls else quiet_s + TICK_S
        assert ours.over or quiet_s < 60.0, "no decision for a minute"
        states.add(ours.state)
    assert len(states) >= 8
    assert ours.over or State.PLAY in states


@pytest.mark.parametrize("automatic", [True, False])
@pytest.mark.parametrize("seed", range(2))
def test_random_commands_do_the_same_for_both_teams(seed: int, automatic: bool) -> None:
    rules = TIMES | {"decide": True, "automatic": automatic, "half_s": 60.0}
    ours, theirs = Whistle(Rules(**rules)), Whistle(Rules(**rules, first_kick_off="magenta"))
    chance, orders, done = Chance(seed, ours), random.Random(seed), set()
    for tick in range(3000):
        sight = chance.sight()
        ours.step(TICK_S, sight)
        theirs.step(TICK_S, other_side(sight))
        if orders.random() < 0.1:
            name, team = orders.choice(COMMANDS), orders.choice(("", "cyan", "magenta"))
            robot = orders.choice(NAMES) if orders.random() < 0.1 else ""
            refused = carry_out(ours, sight, name, team, robot)
            refused_to_others = carry_out(theirs, other_side(sight), name, exchanged(team), exchanged(robot))
            assert bool(refused) == bool(refused_to_others), (
                f"tick {tick}: {name} {team} {robot}: {refused or refused_to_others}"
            )
            done |= set() if refused else {name}
            ours = chance.whistle = restarted(ours)
        assert stand(ours, mirrored=True) == stand(theirs, mirrored=False), f"tick {tick}: {sight.events}"
    assert len(done) > 0.8 * len(COMMANDS), "most commands are not always refused"


def restarted(whistle: Whistle) -> Whistle:
    """Returns the referee that goes on after a restart."""
    again = Whistle(whistle.rules)
    recall(again, written(whistle))
    again.calls = whistle.calls
    return again
