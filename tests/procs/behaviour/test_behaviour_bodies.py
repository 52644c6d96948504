"""Sizes of robots and ball, and the ball's friction: what they change in agent, skiller and navigator."""

import math
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import ball_estimate_t, game_state_t, robot_estimate_t
from procs.behaviour import aim, ballistics, obstacles
from procs.behaviour.agent import Agent
from procs.behaviour.bodies import USUAL, Bodies
from procs.behaviour.navigator import Navigator
from procs.behaviour.passing import taken
from procs.behaviour.roles import time_to_ball_s
from procs.behaviour.skiller import Skiller
from procs.behaviour.skills.getting import GetBall
from procs.behaviour.skills.keeping import best_save
from procs.behaviour.skills.searching import way_is_free
from procs.behaviour.skills.skill import Obstacle, Scene, Sight
from procs.behaviour.view import Ball
from procs.model.ball import BALL
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.robot import ROBOT
from tests.procs.behaviour.behaviour_parts import FIELD, ball, robot, view

LARGE_ROBOT = Bodies.of(ROBOT.model_copy(update={"radius_m": 0.35}), BALL)
SMALL_BALL = Bodies.of(ROBOT, BALL.model_copy(update={"radius_m": 0.05}))
OWN = robot("cyan2", 0.0, 0.0)


def estimate(x_m: float, y_m: float) -> robot_estimate_t:
    made = robot_estimate_t()
    made.x_m, made.y_m = x_m, y_m
    return made


def seen_ball(x_m: float) -> ball_estimate_t:
    made = ball_estimate_t()
    made.known, made.x_m = True, x_m
    return made


def tick(bench: Bench, port: str, held: bool = False, **model: Any) -> Any:
    """One tick of play; returns the newest message of a port."""
    bench.port("world_model").put(localized=True, **model)
    bench.port("kicker_state").put(ball_held=held, charged=True)
    if hasattr(bench.component, "game_state"):
        bench.port("game_state").put(state=game_state_t.PLAY)
    bench.iterate()
    return bench.port(port).sent[-1]


@pytest.mark.parametrize(
    ("settings", "skill"),
    [
        ({}, "lob"),
        ({"ball": {"radius_m": 0.03}}, "shoot"),
        ({"robot": {"radius_m": 0.15}}, "shoot"),
        ({"robot": {"radius_m": 0.45}}, "dribble"),
    ],
)
def test_agent_shoots_where_sizes_leave_room(settings: dict[str, Any], skill: str) -> None:
    bench = Bench(Agent, "cyan2/agent", **settings)
    rivals = [estimate(10.5, 0.0), estimate(8.0, -0.6), estimate(8.0, 0.6)]
    for _ in range(5):
        command = tick(bench, "skill", held=True, x_m=6.0, ball=seen_ball(6.33), opponents=rivals)
    assert command.skill == skill


def drive_to_ball_m(bench: Bench) -> float:
    """Returns how far from the ball the skiller lets the robot stop."""
    bench.skill.put(skill="get_ball")
    return 4.0 - float(tick(bench, "drive_target", ball=seen_ball(4.0)).x_m)


def test_skiller_stops_a_robot_with_a_long_mouth_further_away() -> None:
    usual_m, long_m = (
        drive_to_ball_m(Bench(Skiller, "cyan2/skiller", robot={"mouth_half_angle_deg": angle_deg}))
        for angle_deg in (30.0, 10.0)
    )
    assert long_m - usual_m == pytest.approx(0.25 * (math.cos(math.radians(10)) - math.cos(math.radians(30))))
    assert drive_to_ball_m(Bench(Skiller, "cyan2/skiller", ball={"radius_m": 0.05})) == pytest.approx(usual_m - 0.06)


def test_skiller_passes_harder_on_a_carpet_that_brakes_more() -> None:
    speeds_m_s = []
    for rolling_m_s2 in (0.4, 0.8):
        bench = Bench(Skiller, "cyan2/skiller", ball={"rolling_m_s2": rolling_m_s2})
        bench.skill.put(skill="pass", x_m=6.0)
        for _ in range(3):
            tick(bench, "skill_status", held=True, ball=seen_ball(0.33))
        speeds_m_s.append(bench.kick.sent[0].speed_m_s)
    assert speeds_m_s[1] > speeds_m_s[0] + 0.3


def test_navigator_turns_about_a_point_near_its_ball() -> None:
    bench = Bench(Navigator, "cyan2/navigator", robot={"mouth_half_angle_deg": 20.0})
    pivots_m = []
    for size_m in (0.4, 0.2):
        bench.component.config.robot = ROBOT.model_copy(update={"radius_m": size_m, "mouth_half_angle_deg": 20.0})
        bench.component.config_changed()
        bench.port("drive_target").put(heading_rad=2.0)
        command = tick(bench, "motor_command", held=True)
        pivots_m.append(-command.vy_m_s / command.omega_rad_s)
    assert pivots_m == pytest.approx([0.6 * (size_m * math.cos(math.radians(20)) + 0.11) for size_m in (0.4, 0.2)])


def test_navigator_drives_further_around_larger_robots() -> None:
    asides_m_s = []
    for radius_m in (0.15, 0.25, 0.35):
        bench = Bench(Navigator, "cyan2/navigator", robot={"radius_m": radius_m})
        for _ in range(8):
            bench.port("drive_target").put(x_m=4.0, avoid_robots=True)
            command = tick(bench, "motor_command", opponents=[estimate(2.0, 0.05)])
        asides_m_s.append(-command.vy_m_s)
    assert asides_m_s == sorted(asides_m_s)
    assert asides_m_s[-1] > asides_m_s[0] + 0.1


def test_smaller_ball_leaves_more_room_beside_post_and_robot() -> None:
    start, rival = Point(6.0, 0.0), [robot("", 9.0, 0.6)]
    at_post = [aim.best_shot(start, [], FIELD, bodies).free_rad for bodies in (SMALL_BALL, USUAL)]
    beside = [aim.lane_rad(start, Point(11.0, 0.0), rival, bodies) for bodies in (SMALL_BALL, USUAL, LARGE_ROBOT)]
    assert at_post == sorted(at_post, reverse=True)
    assert beside == sorted(beside, reverse=True)
    assert beside[0] > beside[1] > beside[2]


def test_lob_passes_over_a_tall_robot() -> None:
    tall = Bodies.of(ROBOT.model_copy(update={"height_m": 0.8}), BALL)
    lob = ballistics.lob(5.0, tall)
    assert lob.clear_m(0.8) < 5.0
    assert ballistics.lob(5.0, USUAL).clear_m(0.8) == math.inf


def test_ball_that_rolls_far_is_met_further_on() -> None:
    smooth = Bodies.of(ROBOT, BALL.model_copy(update={"rolling_m_s2": 0.1}))
    seen = view(OWN, Ball(known=True, place=Point(-4.0, 3.0), velocity_m_s=Point(2.5, 0.0)))
    assert ballistics.meet(seen._replace(bodies=smooth)).place.x_m > ballistics.meet(seen).place.x_m


@pytest.mark.parametrize("radius_m", [0.1, 0.25, 0.35, 0.5])
def test_robot_whose_body_touches_the_ball_has_it(radius_m: float) -> None:
    sizes = Bodies.of(ROBOT.model_copy(update={"radius_m": radius_m}), BALL)
    there = ball(3.0, 0.0)
    for away_m, at_ball in ((sizes.held_ball_m, True), (sizes.beside_m + 0.03, True), (sizes.beside_m + 0.2, False)):
        rival = robot("", 3.0 + away_m, 0.0)
        seen = view(OWN, there, (robot("cyan3", -3.0, 0.0),), (rival,))._replace(bodies=sizes)
        assert taken(seen) is at_ball
        assert (time_to_ball_s(rival, there, ballistics.Course(there, sizes)) == 0.0) is at_ball
        skill = GetBall()
        skill.step(Scene(seen, there.place, 0.0))
        assert (skill.state == "approach/contest") is at_ball


def test_large_keeper_stops_a_ball_further_from_its_middle() -> None:
    spare_s = []
    for bodies in (USUAL, LARGE_ROBOT):
        seen = view(robot("cyan1", -10.5, 0.6), Ball(True, Point(-6.0, 0.0), Point(-4.0, 0.0)))._replace(bodies=bodies)
        save = best_save(Scene(seen, Point(-10.5, 0.0), 0.0))
        assert save is not None
        spare_s.append(save.spare_s)
    assert spare_s[1] > spare_s[0] + 0.01


def test_large_robot_keeps_off_walls_and_posts() -> None:
    corner = Point(12.0, 8.0)
    usual, large = (obstacles.reachable(corner, FIELD, bodies) for bodies in (USUAL, LARGE_ROBOT))
    assert (usual.x_m - large.x_m, usual.y_m - large.y_m) == pytest.approx((0.1, 0.1))
    assert obstacles.inside_walls(usual, FIELD, USUAL)
    assert obstacles.inside_walls(Point(11.78, 0.0), FIELD, USUAL)
    assert not obstacles.inside_walls(Point(11.78, 0.0), FIELD, LARGE_ROBOT)


def test_lost_robot_needs_room_for_its_size() -> None:
    sight = Sight((Obstacle(Point(0.8, 0.7), 0.2),), (Point(3.0, 0.0),))
    seen = view(OWN, ball(2.0, 0.0))
    game = Scene(seen, Point(0.0, 0.0), 0.0, sight=sight)
    game = game._replace(game=game.game._replace(state=State.PLAY, stopped=False))
    assert way_is_free(game, 1.0)
    assert not way_is_free(game._replace(view=seen._replace(bodies=LARGE_ROBOT)), 1.0)
