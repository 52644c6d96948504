"""Skills of one situation: receive a pass, clear the ball, block a set piece or a rival."""

import math

import pytest

from procs.behaviour.game import Game, Whose
from procs.behaviour.skills.getting import Intercept, Receive
from procs.behaviour.skills.moving import Block
from procs.behaviour.skills.playing import Clear, Shoot
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.view import Agreement, Ball, View
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.behaviour.behaviour_parts import ball, robot, view

OWN = robot("cyan2", 0.0, 0.0)
PASSER = robot("cyan3", 5.0, 1.0)._replace(agreement=Agreement("cyan2", OWN.place))
FREE_KICK = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(2.0, 1.0))


def scene(seen: View, x_m: float = 0.0, y_m: float = 0.0, **more: object) -> Scene:
    return Scene(seen, Point(x_m, y_m), 0.0, **more)  # type: ignore[arg-type]


def drive(step: Step) -> Drive:
    assert step.drive is not None
    return step.drive


def test_receiver_stands_and_looks_at_the_ball_of_the_passer() -> None:
    skill = Receive()
    target = drive(skill.step(scene(view(OWN, ball(4.7, 0.9, -2.0, 0.0), (PASSER,)))))
    assert (skill.state, target.place) == ("await", OWN.place)
    assert target.heading_rad == pytest.approx(math.atan2(0.9, 4.7))


def test_receiver_looks_at_its_passer_while_the_ball_is_hidden() -> None:
    mates = (robot("cyan4", -3.0, 0.0), PASSER)
    assert drive(Receive().step(scene(view(OWN, Ball(known=False), mates)))).heading_rad == math.atan2(1.0, 5.0)
    assert Receive().step(scene(view(OWN, Ball(known=False), mates[:1]))).status is Status.FAILED


def test_receiver_meets_the_pass_as_intercept_does() -> None:
    receive, intercept = Receive(), Intercept()
    receive.step(scene(view(OWN, ball(4.7, 0.9), (PASSER,))))
    flying = scene(view(OWN, ball(3.5, 0.5, -4.0, -0.4), (PASSER,)))
    assert receive.step(flying) == intercept.step(flying)
    assert receive.state == "approach/meet it/wait"
    held = flying._replace(holds_ball=True)
    assert [receive.step(held).status for _ in range(3)][-1] is Status.FINAL


@pytest.mark.parametrize("where", [ball(3.5, 0.5, 4.0, 0.4), ball(3.5, 0.5, -1.0, 0.0), ball(4.7, 1.0, -4.0, 0.0)])
def test_receiver_waits_for_a_ball_that_was_not_passed_to_it(where: Ball) -> None:
    skill = Receive()
    skill.step(scene(view(OWN, where, (PASSER,))))
    assert skill.state == "await"


def test_clearance_is_kicked_sooner_than_a_shot() -> None:
    def ticks(skill: Shoot, turn_rad: float) -> int:
        """Returns how many ticks a robot that turns steadily needs until it kicks at a place 8 m away."""
        for tick in range(40):
            own = robot("cyan2", 0.0, 0.0, -0.8 + turn_rad * tick)
            step = skill.step(scene(view(own, ball(0.33, 0.0)), 8.0, holds_ball=True))
            if step.kick_m_s:
                assert step.kick_m_s > 10.0
                return tick
        return 40

    assert ticks(Clear(), 0.05) < ticks(Shoot(), 0.05) < 40


def test_block_keeps_the_distance_before_their_free_kick() -> None:
    seen, skill = view(robot("cyan2", -3.0, 1.0), ball(2.0, 1.0)), Block()
    target = drive(skill.step(scene(seen, 2.0, 1.0, game=FREE_KICK)))
    assert skill.state == "get in the way/keep the distance"
    assert 3.0 < math.dist(target.place, FREE_KICK.spot) < 3.5
    assert target.place.x_m < -1.0
    assert abs(target.place.y_m) < 1.0
    there = view(robot("cyan2", *target.place, target.heading_rad), ball(2.0, 1.0))
    assert skill.step(scene(there, 2.0, 1.0, game=FREE_KICK)).status is Status.FINAL


@pytest.mark.parametrize(("stopped", "distance_m"), [(True, 1.3), (False, 1.0)])
def test_block_keeps_the_distance_until_a_ball_is_dropped(stopped: bool, distance_m: float) -> None:
    dropped = FREE_KICK._replace(state=State.DROP_BALL, whose=Whose.NEITHER, stopped=stopped)
    target = drive(Block().step(scene(view(OWN, ball(2.0, 1.0)), 2.0, 1.0, game=dropped)))
    assert math.dist(target.place, dropped.spot) == pytest.approx(distance_m)


def test_block_leaves_the_circle_before_it_takes_its_place() -> None:
    near = view(robot("cyan2", 3.0, 1.0), ball(2.0, 1.0))
    target = drive(Block().step(scene(near, 2.0, 1.0, game=FREE_KICK)))
    assert math.dist(target.place, FREE_KICK.spot) > 3.0
    assert target.place.x_m > 3.0


@pytest.mark.parametrize("whose", [Whose.OURS, Whose.NEITHER])
def test_block_stands_close_before_a_dribbling_rival(whose: Whose) -> None:
    rival = robot("", 2.3, 0.0)
    seen = view(OWN, ball(2.0, 0.0, 0.0, 1.0), (), (rival,))
    target = drive(Block().step(scene(seen, 2.0, 0.0, game=FREE_KICK._replace(whose=whose))))
    assert target.place.x_m == pytest.approx(1.0, abs=0.05)
    assert 0.2 < target.place.y_m < 0.4, "it leads"
    assert target.avoid_ball


def test_block_far_from_the_ball_blocks_the_place() -> None:
    target = drive(Block().step(scene(view(OWN, ball(8.0, 5.0)), -5.0, 0.0)))
    assert target.place == pytest.approx((-6.0, 0.0))
    assert target.heading_rad == pytest.approx(0.0)
