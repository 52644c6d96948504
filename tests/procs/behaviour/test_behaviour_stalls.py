"""Robots that should go for the ball or elsewhere, but stand: the team does without them for a while."""

from collections.abc import Mapping

import pytest

from procs.behaviour.game import Game, Whose
from procs.behaviour.posts import PLAY
from procs.behaviour.roles import ATTACKER, SUPPORTER, Job, assign
from procs.behaviour.stalls import NO_JOBS, Stalls
from procs.behaviour.view import Ball, Robot, View
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.behaviour.behaviour_parts import FIELD, agreed, ball, job, robot, view

KEEPER, SUPPORT = robot("cyan1", -10.5, 0.0), robot("cyan3", -1.0, 2.0, role=SUPPORTER)
HELD = robot("cyan2", 2.0, 0.0, role=ATTACKER)
BALL = ball(3.0, 1.0)
TICK_S = 0.05


def seen(attacker: Robot = HELD, where: Ball = BALL, *rivals: Robot) -> View:
    return view(SUPPORT, where, (KEEPER, attacker), rivals)


def stalled_after(
    stalls: Stalls, time_s: float, what: View, game: Game = PLAY, jobs: Mapping[str, Job] = NO_JOBS
) -> frozenset[str]:
    """Returns the robots that are stalled after a time in which nothing changes."""
    found: frozenset[str] = frozenset()
    for _ in range(round(time_s / TICK_S)):
        found = stalls.watch(what, game, FIELD, TICK_S, jobs)
    return found


def test_attacker_that_stands_is_stalled_until_it_moves() -> None:
    stalls = Stalls()
    assert not stalled_after(stalls, 2.0, seen())
    assert stalled_after(stalls, 1.0, seen()) == {"cyan2"}
    relieved = HELD._replace(role=SUPPORTER)
    assert stalled_after(stalls, 5.0, seen(relieved)) == {"cyan2"}
    assert not stalled_after(stalls, TICK_S, seen(relieved._replace(place=Point(1.5, 0.0))))


def test_stalled_robot_is_tried_again_after_a_while() -> None:
    stalls, relieved = Stalls(), HELD._replace(role=SUPPORTER)
    assert stalled_after(stalls, 3.0, seen()) == {"cyan2"}
    assert not stalled_after(stalls, 10.5, seen(relieved))
    assert not stalled_after(stalls, 2.0, seen()), "it has the usual time again"


@pytest.mark.parametrize("where", [ball(10.45, 1.5), ball(10.7, 2.25)], ids=["before", "beside"])
def test_attacker_is_stalled_before_a_ball_that_it_may_reach(where: Ball) -> None:
    """The ball lies in the rivals' goal area or beside it, within reach of a robot outside."""
    assert stalled_after(Stalls(), 3.0, seen(where=where)) == {"cyan2"}


def test_mate_with_the_own_name_changes_nothing() -> None:
    twin = HELD._replace(place=Point(-5.0, 0.0), role=SUPPORTER)
    assert stalled_after(Stalls(), 3.0, view(HELD, BALL, (KEEPER, twin, SUPPORT, SUPPORT))) == {"cyan2"}


def test_robot_finds_itself_stalled() -> None:
    assert stalled_after(Stalls(), 3.0, view(HELD, BALL, (KEEPER, SUPPORT))) == {"cyan2"}


@pytest.mark.parametrize(
    "what",
    [
        seen(HELD._replace(role=SUPPORTER)),
        seen(agreed(HELD)),
        seen(HELD, BALL._replace(known=False)),
        seen(HELD, ball(3.0, 1.0, -1.0)),
        seen(HELD, ball(-9.0, 1.0)),
        seen(HELD, BALL, robot("magenta2", 3.6, 1.0)),
        seen(HELD._replace(place=Point(10.15, 1.5)), ball(10.7, 1.5)),
    ],
    ids=[
        "supporter",
        "awaits a pass",
        "ball unknown",
        "ball rolls",
        "ball is the keeper's",
        "rival is at the ball",
        "ball is in the rivals' goal area",
    ],
)
def test_robot_with_a_reason_to_stand_is_not_stalled(what: View) -> None:
    assert not stalled_after(Stalls(), 5.0, what)


@pytest.mark.parametrize(
    ("game", "stalls"),
    [
        (Game(State.THROW_IN, stopped=False, whose=Whose.OURS), True),
        (Game(State.THROW_IN, stopped=True, whose=Whose.OURS), False),
        (Game(State.THROW_IN, stopped=False, whose=Whose.THEIRS), False),
        (Game(State.DROP_BALL, stopped=False, whose=Whose.NEITHER), True),
        (Game(State.FROZEN, stopped=True), False),
    ],
)
def test_taker_of_a_set_piece_may_stand_until_the_start(game: Game, stalls: bool) -> None:
    assert bool(stalled_after(Stalls(), 5.0, seen(), game)) == stalls


AWAY = {"cyan3": job(SUPPORTER, 5.0, 2.0)}
PRESENT = view(HELD, BALL, (KEEPER, SUPPORT))


def test_supporter_that_stands_far_from_its_place_is_stalled() -> None:
    stalls = Stalls()
    assert "cyan3" not in stalled_after(stalls, 2.0, PRESENT, PLAY, AWAY)
    asked = view(HELD, BALL, (KEEPER, agreed(SUPPORT)))
    assert "cyan3" not in stalled_after(stalls, 3.0, asked, PLAY, AWAY), "it stands for the pass"
    assert "cyan3" in stalled_after(stalls, 1.0, PRESENT, PLAY, AWAY), "the time before counts on"
    driving = view(HELD, BALL, (KEEPER, SUPPORT._replace(place=Point(-0.5, 2.0))))
    assert "cyan3" not in stalled_after(stalls, TICK_S, driving, PLAY, AWAY)


@pytest.mark.parametrize(
    ("what", "game", "place"),
    [
        (PRESENT, PLAY, (1.5, 2.0)),
        (PRESENT, Game(State.FROZEN, stopped=True), (5.0, 2.0)),
        (PRESENT._replace(opponents=(robot("", -2.0, 2.0),)), PLAY, (5.0, 2.0)),
        (PRESENT._replace(ball=Ball(known=False)), PLAY, (5.0, 2.0)),
    ],
    ids=["near its place", "pause", "marks a rival", "ball unknown"],
)
def test_helper_with_a_reason_to_stand_is_not_stalled(what: View, game: Game, place: tuple[float, float]) -> None:
    assert "cyan3" not in stalled_after(Stalls(), 5.0, what, game, {"cyan3": job(SUPPORTER, *place)})


def test_mate_attacks_instead_of_a_stalled_robot() -> None:
    for stalled, attacker in ((frozenset[str](), "cyan2"), ({"cyan2"}, "cyan3"), ({"cyan2", "cyan3"}, "cyan2")):
        jobs = assign(seen(), FIELD, stalled=stalled)
        assert [name for name, job in jobs.items() if job.role == ATTACKER] == [attacker]
