"""The skills: scenes and the steps that follow."""

import math

import pytest

from procs.behaviour import ballistics
from procs.behaviour.bodies import USUAL
from procs.behaviour.skills.book import SkillRunner
from procs.behaviour.skills.getting import GetBall, Intercept
from procs.behaviour.skills.keeping import KeepGoal, KeepLine
from procs.behaviour.skills.moving import Goto, Mark
from procs.behaviour.skills.playing import Aim, Dribble, Lob, Pass, Push, Shoot
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.view import Ball, View
from procs.model.ball import BALL
from procs.model.field import Point
from procs.model.robot import ROBOT
from tests.procs.behaviour.behaviour_parts import ball, robot, view

OWN = robot("cyan2", 0.0, 0.0)
FAR_BALL = ball(5.0, 0.0)


def scene(seen: View, x_m: float = 8.0, y_m: float = 0.0, heading_rad: float = 0.0, **more: float) -> Scene:
    return Scene(seen, Point(x_m, y_m), heading_rad, **more)  # type: ignore[arg-type]


def drive(step: Step) -> Drive:
    assert step.drive is not None
    return step.drive


def test_goto_drives_there_around_the_ball_and_stays() -> None:
    going = Goto().step(scene(view(OWN, FAR_BALL), 3.0, 1.0, 0.5, speed_m_s=1.0))
    assert going.drive == Drive(Point(3.0, 1.0), 0.5, 1.0, avoid_ball=True)
    assert going.status is Status.RUNNING
    there = Goto().step(scene(view(robot("cyan2", 3.0, 1.05, 0.52), FAR_BALL), 3.0, 1.0, 0.5))
    assert there.status is Status.FINAL
    assert there.drive is not None


def test_mark_stands_between_opponent_and_goal_facing_the_ball() -> None:
    place = drive(Mark().step(scene(view(OWN, FAR_BALL), -5.0, 4.0)))
    assert -6.0 < place.place.x_m < -5.0
    assert 3.0 < place.place.y_m < 4.0
    assert abs(place.heading_rad) < math.pi / 2


def test_get_ball_drives_mouth_first_and_handles_when_near() -> None:
    far = GetBall().step(scene(view(OWN, ball(4.0, 3.0))))
    assert drive(far).heading_rad == pytest.approx(math.atan2(3.0, 4.0))
    assert 0.2 < math.dist(drive(far).place, (4.0, 3.0)) < 0.33
    assert not far.dribble
    assert GetBall().step(scene(view(OWN, ball(0.7, 0.0)))).dribble


@pytest.mark.parametrize("away_m", [0.38, 0.45, 0.55, 0.65, 0.75])
def test_get_ball_comes_from_beside_a_standing_rival(away_m: float) -> None:
    rival = robot("", 4.0 - away_m, 0.0)
    beside = drive(GetBall().step(scene(view(OWN, ball(4.0, 0.0), opponents=(rival,)))))
    assert math.dist(beside.place, rival.place) > 2 * ROBOT.radius_m
    assert 0.2 < math.dist(beside.place, (4.0, 0.0)) < 0.33
    ahead_m = Point(4.0 - beside.place.x_m, -beside.place.y_m)
    assert beside.heading_rad == pytest.approx(math.atan2(ahead_m.y_m, ahead_m.x_m))


def test_get_ball_expects_a_driving_rival_to_leave() -> None:
    leaving = robot("", 3.4, 0.0)._replace(velocity_m_s=Point(0.0, 1.0))
    straight = drive(GetBall().step(scene(view(OWN, ball(4.0, 0.0), opponents=(leaving,)))))
    assert straight.heading_rad == pytest.approx(0.0)


def test_get_ball_is_final_when_the_ball_stays_in_the_mouth() -> None:
    skill, held = GetBall(), scene(view(OWN, ball(0.33, 0.0)), holds_ball=True)
    assert skill.step(held).status is Status.RUNNING
    assert skill.step(held._replace(holds_ball=False)).status is Status.RUNNING
    assert [skill.step(held).status for _ in range(2)] == [Status.RUNNING, Status.FINAL]


def test_get_ball_fails_without_a_ball() -> None:
    step = GetBall().step(scene(view(OWN, Ball(known=False))))
    assert (step.status, step.drive) == (Status.FAILED, None)
    assert "ball" in step.reason


def test_set_pieces_ball_is_taken_from_behind() -> None:
    beside = view(robot("cyan2", 0.0, 1.0), ball(0.0, 0.0))
    staging = drive(GetBall().step(scene(beside, set_piece=True)))
    assert staging.place.x_m < -0.5
    assert staging.avoid_ball
    behind = view(robot("cyan2", -0.7, 0.0), ball(0.0, 0.0))
    assert not drive(GetBall().step(scene(behind, set_piece=True))).avoid_ball


def test_ball_before_the_own_goal_is_touched_with_the_mouth_only() -> None:
    for heading_rad, waits in ((0.0, True), (math.pi, False)):
        seen = view(robot("cyan1", -10.4, 0.2, heading_rad), ball(-10.8, 0.2))
        place = drive(GetBall().step(scene(seen))).place
        assert (math.dist(place, seen.ball.place) > 0.5) is waits
    beside = view(robot("cyan1", -10.4, 2.0), ball(-10.8, 2.0))
    assert math.dist(drive(GetBall().step(scene(beside))).place, beside.ball.place) < 0.4


def test_ball_of_an_opponent_is_attacked_from_own_goal_side() -> None:
    seen = view(robot("cyan2", 1.0, 2.0), ball(0.0, 0.0), (), (robot("", 0.33, 0.0),))
    tackle = drive(GetBall().step(scene(seen)))
    assert tackle.place.x_m < -0.2
    assert tackle.heading_rad == pytest.approx(0.0, abs=0.01)


def test_rolling_ball_is_faced_where_it_comes_from() -> None:
    seen = view(robot("cyan2", 0.0, 0.0), ball(3.0, 1.0, 0.0, -2.0))
    assert drive(GetBall().step(scene(seen))).heading_rad == pytest.approx(math.atan2(1.0, 3.0))


def test_robot_stops_with_a_ball_that_it_has_just_caught() -> None:
    own = robot("cyan2", 0.0, 0.0)._replace(velocity_m_s=Point(-1.0, 0.0))
    caught = Intercept().step(scene(view(own, ball(0.33, 0.0, -1.3, 0.0)), holds_ball=True))
    assert drive(caught) == Drive(own.place, 0.0)
    assert caught.dribble


def test_intercept_waits_on_the_balls_path_facing_it() -> None:
    wait = drive(Intercept().step(scene(view(robot("cyan2", -1.0, 0.6), ball(4.0, 0.0, -3.0, 0.0)))))
    assert -1.0 <= wait.place.x_m < 1.0
    assert wait.place.y_m == pytest.approx(0.0)
    assert wait.heading_rad == pytest.approx(0.0, abs=0.01)


def test_dribble_turns_before_it_would_pull_the_ball_back() -> None:
    held = scene(view(OWN, ball(0.33, 0.0)), -3.0, 0.5, holds_ball=True)
    step = Dribble().step(held)
    assert step.drive
    assert step.drive.place == OWN.place
    assert abs(step.drive.heading_rad) > 2.5


def test_dribble_drives_mouth_first_and_fails_without_the_ball() -> None:
    skill, held = Dribble(), scene(view(OWN, ball(0.33, 0.0)), 4.0, 4.0, holds_ball=True)
    step = skill.step(held)
    assert step.dribble
    assert drive(step).heading_rad == pytest.approx(math.pi / 4)
    lost = [skill.step(held._replace(holds_ball=False)).status for _ in range(8)]
    assert lost[:5] == [Status.RUNNING] * 5
    assert lost[-1] is Status.FAILED


def test_dribble_ends_at_the_nearest_place_that_is_permitted() -> None:
    edge = Point(10.0, 0.0)
    near = scene(view(robot("cyan2", 9.9, 0.0), ball(10.23, 0.0)), 10.7, 0.0, holds_ball=True)
    near = near._replace(permitted=lambda _: edge)
    assert Dribble().step(near).status is Status.FINAL
    far = near._replace(view=view(robot("cyan2", 9.5, 0.0), ball(9.83, 0.0)))
    assert Dribble().step(far).status is Status.RUNNING


@pytest.mark.parametrize(("skill", "status"), [(Pass, Status.FAILED), (Push, Status.FAILED), (Shoot, Status.RUNNING)])
@pytest.mark.parametrize("x_m", [0.0, 0.25])
def test_pass_to_the_robot_itself_fails(skill: type[Pass | Shoot], status: Status, x_m: float) -> None:
    step = skill().step(scene(view(OWN, ball(0.33, 0.0)), x_m, 0.0, holds_ball=True))
    assert step.status is status
    if status is Status.FAILED:
        assert (step.reason, step.kick_m_s) == ("the place is at the robot itself", 0.0)


def test_aim_turns_to_the_place_and_waits_there_without_a_kick() -> None:
    skill = Aim()
    turning = skill.step(scene(view(OWN, ball(0.33, 0.0)), 0.0, 5.0, holds_ball=True))
    assert drive(turning).heading_rad == pytest.approx(math.pi / 2)
    assert turning.status is Status.RUNNING
    turned = scene(view(robot("cyan2", 0.0, 0.0, 1.55), ball(0.0, 0.33)), 0.0, 5.0, holds_ball=True)
    steps = [skill.step(turned) for _ in range(20)]
    assert {(step.kick_m_s, step.dribble, step.status) for step in steps} == {(0.0, True, Status.FINAL)}


def test_shoot_turns_first_and_kicks_when_aimed() -> None:
    skill = Shoot()
    aside = scene(view(OWN._replace(heading_rad=0.5), ball(0.3, 0.1)), holds_ball=True)
    turning = skill.step(aside)
    assert turning.kick_m_s == 0.0
    assert drive(turning).heading_rad == pytest.approx(0.0)
    aimed = aside._replace(view=view(OWN, ball(0.33, 0.0)))
    steps = [skill.step(aimed) for _ in range(2)]
    assert steps[-1].kick_m_s > 8.0
    assert skill.step(aimed).status is Status.RUNNING
    assert skill.step(aimed._replace(kicked=True, holds_ball=False)).status is Status.FINAL


def test_lob_lifts_the_ball_over_robots_and_under_the_bar() -> None:
    held = scene(view(OWN, ball(0.33, 0.0)), 6.0, holds_ball=True)
    lob = Lob().step(held)
    time_s = (6.0 - 0.33) / lob.kick_m_s
    height_m = lob.kick_m_s * math.tan(lob.elevation_rad) * time_s - 9.81 * time_s**2 / 2
    assert ROBOT.height_m < height_m < 1.0 - 2 * BALL.radius_m
    driving = held._replace(view=view(OWN._replace(velocity_m_s=Point(1.0, 0.0)), ball(0.33, 0.0)))
    moved = Lob().step(driving)
    assert moved.kick_m_s == pytest.approx(lob.kick_m_s, abs=0.1), (
        "the robot's own speed makes the lob faster and flatter"
    )
    lifts = [step.kick_m_s * math.tan(step.elevation_rad) for step in (lob, moved)]
    assert lifts[0] > lifts[1] + 0.05
    far = Lob().step(scene(view(OWN, ball(0.33, 0.0)), 10.5, holds_ball=True))
    assert far.kick_m_s / math.cos(far.elevation_rad) < 12.0, "more than the kicker can"
    assert Shoot().step(held).elevation_rad == 0.0


def test_kick_waits_while_the_aim_still_improves() -> None:
    skill = Pass()
    for tick in range(20):
        heading_rad = -0.1 + 0.01 * tick
        mouth = Point(0.33 * math.cos(heading_rad), 0.33 * math.sin(heading_rad))
        turning = view(OWN._replace(heading_rad=heading_rad), ball(*mouth))
        if skill.step(scene(turning, 4.0, holds_ball=True)).kick_m_s:
            assert abs(heading_rad) < 0.03
            return
    pytest.fail("a robot that has turned to its mate kicks")


def test_shoot_waits_for_the_charge() -> None:
    held = scene(view(OWN, ball(0.33, 0.0)), holds_ball=True)
    assert Shoot().step(held).kick_m_s > 0
    assert Shoot().step(held._replace(charged=False)).kick_m_s == 0.0


def test_kick_allows_for_the_robots_own_motion() -> None:
    moving = OWN._replace(velocity_m_s=Point(0.0, 1.0))
    turn = drive(Shoot().step(scene(view(moving, ball(0.33, 0.0)), holds_ball=True)))
    assert -0.2 < turn.heading_rad < -0.05


def test_kick_that_the_kicker_ignores_is_requested_again() -> None:
    skill, held = Shoot(), scene(view(OWN, ball(0.33, 0.0)), holds_ball=True)
    assert skill.step(held).kick_m_s > 0
    assert [skill.step(held).kick_m_s for _ in range(8)] == [0.0] * 8
    assert skill.step(held._replace(kicked=False)).kick_m_s > 0


def test_kick_before_this_skill_does_not_count_as_its_own() -> None:
    step = Shoot().step(scene(view(OWN, ball(0.33, 0.0)), holds_ball=True, kicked=True))
    assert (step.status, step.kick_m_s > 0) == (Status.RUNNING, True)


def test_pass_is_softer_the_nearer_the_mate_is() -> None:
    near, far = (Pass().step(scene(view(OWN, ball(0.33, 0.0)), x_m, holds_ball=True)).kick_m_s for x_m in (3.0, 8.0))
    assert 2.5 < near < far < 7.0


def test_pass_arrives_at_the_mouth_at_the_wanted_speed() -> None:
    distance_m, arrival_m_s = 2.7, 2.2
    kick_m_s = (
        Pass().step(scene(view(OWN, ball(0.33, 0.0)), distance_m, speed_m_s=arrival_m_s, holds_ball=True)).kick_m_s
    )
    rolls_m = distance_m - 2 * ROBOT.held_ball_m(BALL)
    assert kick_m_s == pytest.approx(ballistics.kick_speed_m_s(rolls_m, arrival_m_s, USUAL), rel=0.01)


def test_aiming_without_end_fails() -> None:
    skill, held = Shoot(), scene(view(OWN._replace(heading_rad=2.0), ball(0.0, 0.33)), holds_ball=True)
    assert [skill.step(held).status for _ in range(70)][-1] is Status.FAILED


@pytest.mark.parametrize(("vy_m_s", "crossing_m"), [(0.0, 0.5), (-1.0, -1.05), (-4.0, None)])
def test_keeper_goes_where_the_shot_will_cross_its_line(vy_m_s: float, crossing_m: float | None) -> None:
    keeper = robot("cyan1", -10.5, 0.0)
    place = drive(KeepLine().step(scene(view(keeper, ball(-5.0, 0.5, -3.0, vy_m_s))))).place
    assert -11.0 < place.x_m < -10.3
    if crossing_m is not None:
        assert place.y_m == pytest.approx(crossing_m)
    else:
        assert place.y_m > -0.2  # goes wide


@pytest.mark.parametrize(
    ("shot", "state"),
    [
        (ball(-4.0, 0.0, -5.0, 0.6), "meet"),
        (ball(-6.0, 0.5, -6.5, -1.56), "dive"),
        (ball(-9.0, 0.5, -9.0, 0.9), "block"),
        (ball(-5.0, 0.5, -4.0, -4.0), "let it go"),
        (ball(-10.0, 1.6, -0.7, 0.1), "let it go"),
        (ball(-10.0, 0.5, -0.7, 0.0), "come out"),
        (ball(-5.0, 0.5, 1.0, 0.0), "come out"),
        (Ball(known=False), "wait in the middle"),
    ],
)
def test_keeper_dives_for_shots_that_it_cannot_stop_at_in_time(shot: Ball, state: str) -> None:
    skill, keeper = KeepGoal(), robot("cyan1", -10.4, 0.0)
    place = drive(skill.step(scene(view(keeper, shot), -8.7, 0.0)))
    assert skill.state.split("/")[-1] == state
    assert (place.end_speed_m_s > 2.0) == (state == "dive")
    if state == "dive":
        crossing_m = shot.place.y_m + shot.velocity_m_s.y_m * (shot.place.x_m - place.place.x_m) / 6.5
        assert place.place.y_m < crossing_m - 0.2, "past the ball's way, at full speed"


def test_keeper_comes_out_further_the_nearer_the_ball_is() -> None:
    keeper = robot("cyan1", -10.4, 0.0)

    def out_m(ball_x_m: float, furthest_x_m: float) -> float:
        step = KeepGoal().step(scene(view(keeper, ball(ball_x_m, 0.0)), furthest_x_m, 0.0))
        return drive(step).place.x_m + 11.0

    assert out_m(0.0, -8.7) == pytest.approx(0.45)
    assert 0.5 < out_m(-5.5, -8.7) < out_m(-6.5, -8.7) < 2.3
    assert out_m(-8.5, -8.7) == pytest.approx(2.3)
    assert out_m(-8.5, -10.55) == pytest.approx(0.45), "no further than it is told"


@pytest.mark.parametrize("own_rad", [1.0, -1.0])
def test_keeper_before_a_ball_behind_it_keeps_its_side(own_rad: float) -> None:
    """The noise of the ball once turned it to and fro."""
    seen = [view(robot("cyan1", -9.0, 0.0, own_rad), ball(-10.8, y_m)) for y_m in (0.04, -0.04)]
    headings_rad = [drive(KeepGoal().step(scene(each, -8.7))).heading_rad for each in seen]
    assert headings_rad == pytest.approx([math.copysign(1.3, own_rad)] * 2)


def test_keeper_covers_the_ball_side_between_the_posts() -> None:
    keeper = robot("cyan1", -10.5, 0.0)
    left, right = (drive(KeepGoal().step(scene(view(keeper, ball(-9.0, y_m))))).place.y_m for y_m in (5.0, -5.0))
    assert 0.3 < left < 1.0
    assert right == pytest.approx(-left)
    assert drive(KeepGoal().step(scene(view(keeper, Ball(known=False))))).place.y_m == 0.0


def test_machine_updates_a_running_skill_and_restarts_an_ended() -> None:
    runner, seen = SkillRunner(), view(OWN, Ball(known=False))
    runner.begin("get_ball")
    assert runner.step(scene(seen)).status is Status.FAILED
    assert runner.step(scene(view(OWN, FAR_BALL))).status is Status.FAILED
    runner.begin("get_ball")
    assert runner.step(scene(view(OWN, FAR_BALL))).status is Status.RUNNING
    runner.begin("shoot")
    held = scene(view(OWN, ball(0.33, 0.0)), holds_ball=True)
    assert runner.step(held).kick_m_s > 0
    runner.begin("shoot")
    assert runner.step(held).kick_m_s == 0.0  # still waits for the kick that it asked for
    for x_m in (1.0, 2.0):
        runner.begin("goto")
        assert drive(runner.step(scene(seen, x_m))).place.x_m == x_m


def test_ended_skill_stops_the_robot_and_keeps_the_ball() -> None:
    runner, held = SkillRunner(), scene(view(OWN, ball(0.33, 0.0)), holds_ball=True)
    runner.begin("get_ball")
    steps = [runner.step(held) for _ in range(4)]
    assert [(step.status, step.drive, step.dribble) for step in steps[2:]] == [(Status.FINAL, None, True)] * 2


def test_machine_without_a_command_stands() -> None:
    step = SkillRunner().step(scene(view(OWN, FAR_BALL), holds_ball=True))
    assert (step.status, step.drive, step.dribble, step.kick_m_s) == (Status.INACTIVE, None, False, 0.0)


@pytest.mark.parametrize(("speed_m_s", "omega_rad_s"), [(0.0, 1.0), (3.5, 1.0), (3.5, -1.0)])
def test_kick_allows_for_the_motion_of_the_mouth(speed_m_s: float, omega_rad_s: float) -> None:
    """The ball leaves with the velocity of the mouth, omega x r included, plus the kick."""
    skill, period_s, target = Shoot(), 0.05, Point(8.0, 0.0)
    for tick in range(60):
        heading_rad = -omega_rad_s + omega_rad_s * period_s * tick
        own = OWN._replace(heading_rad=heading_rad, velocity_m_s=Point(0.0, speed_m_s))
        mouth = Point(0.33 * math.cos(heading_rad), 0.33 * math.sin(heading_rad))
        step = skill.step(scene(view(own, ball(*mouth)), *target, holds_ball=True))
        if not step.kick_m_s:
            continue
        kicked_rad = heading_rad + omega_rad_s * 0.04  # the kicker fires a little later
        vx_m_s = step.kick_m_s * math.cos(kicked_rad) - 0.33 * omega_rad_s * math.sin(kicked_rad)
        vy_m_s = step.kick_m_s * math.sin(kicked_rad) + 0.33 * omega_rad_s * math.cos(kicked_rad) + speed_m_s
        way_rad = math.atan2(target.y_m - mouth.y_m, target.x_m - mouth.x_m)
        assert math.atan2(vy_m_s, vx_m_s) == pytest.approx(way_rad, abs=0.06)
        assert math.hypot(vx_m_s, vy_m_s) == pytest.approx(11.0, rel=0.05)
        return
    pytest.fail("a robot that turns through the right heading kicks")


def test_kick_is_weaker_while_driving_at_the_target() -> None:
    skill = Shoot()
    driving = OWN._replace(velocity_m_s=Point(2.0, 0.0))
    kicks = [skill.step(scene(view(driving, ball(0.33, 0.0)), holds_ball=True)).kick_m_s for _ in range(3)]
    assert max(kicks) == pytest.approx(9.0)
