"""Navigator on the bench."""

import itertools
import math
from collections.abc import Callable
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.robot import motor_command_t
from lcmtypes.soccer import ball_estimate_t, game_state_t, mate_estimate_t, navigator_state_t, robot_estimate_t
from procs.behaviour.navigator import Navigator
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import moved, newest, put


def estimate(x_m: float, y_m: float) -> robot_estimate_t:
    made = robot_estimate_t()
    made.x_m, made.y_m = x_m, y_m
    return made


def navigate(ticks: int = 1, localized: bool = True, **target: Any) -> Bench:
    bench = Bench(Navigator, "cyan2/navigator")
    for _ in range(ticks):
        put(bench, "world_model", localized=localized, heading_rad=math.pi / 2)
        put(bench, "odometry")
        put(bench, "drive_target", target_id=7, **target)
        bench.iterate()
    return bench


def test_navigator_drives_in_its_frame_within_its_acceleration() -> None:
    bench = navigate(3, x_m=5.0, heading_rad=math.pi / 2)
    commands = bench.port("motor_command").sent
    assert all(command.enabled for command in commands)
    speeds_m_s = [-command.vy_m_s for command in commands]  # east is to the right of a robot that faces north
    assert speeds_m_s == pytest.approx([0.15, 0.3, 0.45])
    state = newest(bench, "navigator_state")
    assert (state.target_id, state.arrived, state.error) == (7, False, navigator_state_t.OK)
    assert state.distance_m == pytest.approx(5.0 - 0.14 * 0.3 / 2)  # the wheels will follow the last command


def test_navigator_in_every_other_tick_accelerates_as_fast() -> None:
    bench = Bench(Navigator, "cyan2/navigator", every=2)
    for _ in range(6):
        put(bench, "world_model", localized=True)
        put(bench, "odometry")
        put(bench, "drive_target", x_m=5.0)
        bench.iterate()
    assert [command.vx_m_s for command in bench.port("motor_command").sent] == pytest.approx([0.3, 0.6, 0.9])


def changes_m_s(held: bool, x_m: float) -> list[float]:
    """Returns the change of the speed in the first ticks towards a target; the robot faces along x."""
    bench = Bench(Navigator, "cyan2/navigator")
    for _ in range(3):
        put(bench, "world_model", localized=True)
        put(bench, "odometry")
        put(bench, "kicker_state", ball_held=held)
        put(bench, "drive_target", x_m=x_m)
        bench.iterate()
    speeds_m_s = [0.0, *(command.vx_m_s for command in bench.port("motor_command").sent)]
    return [after - before for before, after in itertools.pairwise(speeds_m_s)]


def test_robot_with_the_ball_accelerates_most_towards_it() -> None:
    assert changes_m_s(held=False, x_m=-5.0) == pytest.approx([-0.15] * 3)
    assert changes_m_s(held=True, x_m=-5.0) == pytest.approx([-0.125] * 3)
    assert changes_m_s(held=True, x_m=5.0) == pytest.approx([0.2] * 3)


def test_robot_of_a_silent_kicker_drives_as_without_a_ball() -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    put(bench, "kicker_state", ball_held=True)
    x_m = -5.0
    for _ in range(25):
        put(bench, "world_model", localized=True)
        put(bench, "odometry")
        put(bench, "drive_target", x_m=x_m)
        bench.iterate()
        x_m = -x_m  # it never reaches its highest speed
    speeds_m_s = [0.0, *(command.vx_m_s for command in bench.port("motor_command").sent)]
    changes_m_s = [before - after for before, after in itertools.pairwise(speeds_m_s)]
    assert changes_m_s[0] == pytest.approx(0.125)
    assert changes_m_s[-1] == pytest.approx(0.15)


def test_robot_turns_about_a_point_near_its_ball() -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    put(bench, "world_model", localized=True)
    put(bench, "odometry")
    put(bench, "kicker_state", ball_held=True)
    put(bench, "drive_target", heading_rad=2.0)
    bench.iterate()
    command = newest(bench, "motor_command")
    assert command.omega_rad_s > 0.0
    assert command.vy_m_s / command.omega_rad_s == pytest.approx(-0.6 * 0.327, abs=0.01)


def test_navigator_turns_the_short_way() -> None:
    assert newest(navigate(3, heading_rad=math.pi), "motor_command").omega_rad_s > 0
    assert newest(navigate(3, heading_rad=-math.pi * 0.4), "motor_command").omega_rad_s < 0


@pytest.mark.parametrize(
    ("place", "turns"),
    [((9.0, -7.74), False), ((9.0, 7.84), False), ((-11.74, 3.0), False), ((9.0, -7.6), True), ((11.6, 3.0), True)],
)
def test_robot_at_the_wall_turns_after_it_has_left(place: tuple[float, float], turns: bool) -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    x_m, y_m = place
    put(bench, "world_model", localized=True, x_m=x_m, y_m=y_m)
    put(bench, "odometry")
    put(bench, "drive_target", x_m=7.0, heading_rad=1.5)
    bench.iterate()
    command = newest(bench, "motor_command")
    assert (command.omega_rad_s > 0.0) == turns
    assert math.hypot(command.vx_m_s, command.vy_m_s) > 0.1


@pytest.mark.parametrize(("y_m", "fastest_m_s"), [(7.0, 1.9), (7.5, 1.0), (7.69, 0.3), (7.75, 0.0)])
def test_robot_brakes_before_the_wall(y_m: float, fastest_m_s: float) -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    for at_m in [0.0] * 20 + [y_m]:
        put(bench, "world_model", localized=True, y_m=at_m)
        put(bench, "odometry")
        put(bench, "drive_target", y_m=7.0 if at_m == 0.0 else -3.0)
        bench.iterate()
    assert bench.port("motor_command").sent[-2].vy_m_s > 2.5
    assert newest(bench, "motor_command").vy_m_s <= fastest_m_s


def test_navigator_reports_its_arrival() -> None:
    assert newest(navigate(x_m=0.02, heading_rad=math.pi / 2), "navigator_state").arrived


def test_navigator_keeps_the_speed_limit_of_the_target() -> None:
    command = newest(navigate(60, x_m=8.0, heading_rad=math.pi / 2, speed_m_s=0.8), "motor_command")
    assert math.hypot(command.vx_m_s, command.vy_m_s) == pytest.approx(0.8)


def test_robot_without_a_pose_stands_still_and_reports_it() -> None:
    bench = navigate(5, localized=False, x_m=5.0)
    command = newest(bench, "motor_command")
    assert (command.vx_m_s, command.vy_m_s, command.omega_rad_s) == (0.0, 0.0, 0.0)
    assert newest(bench, "navigator_state").error == navigator_state_t.LOST


def test_old_target_is_braked_to_a_standstill() -> None:
    bench = navigate(10, x_m=5.0, heading_rad=math.pi / 2)
    fast = newest(bench, "motor_command").vy_m_s
    for _ in range(30):
        put(bench, "world_model", localized=True, heading_rad=math.pi / 2)
        bench.iterate()
    assert abs(fast) > 1.0
    assert newest(bench, "motor_command").vy_m_s == 0.0


def test_opponent_in_the_way_is_driven_around() -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    for avoid in (True, False):
        for _ in range(20):
            put(bench, "world_model", localized=True, opponents=[estimate(2.0, 0.05)])
            put(bench, "drive_target", x_m=4.0, avoid_robots=avoid)
            bench.iterate()
        command = newest(bench, "motor_command")
        assert (command.vy_m_s < -0.3) == avoid


@pytest.mark.parametrize(
    ("mate", "role", "reached_m"),
    [("cyan1", "goalkeeper", 10.15), ("cyan1", "absent", 10.8), ("cyan3", "defender", 10.8)],
)
def test_only_goalkeepers_drive_into_goal_areas(mate: str, role: str, reached_m: float) -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    mates = [mate_estimate_t(name=mate, role=role)]
    put(bench, "world_model", localized=True, x_m=10.0, mates=mates)
    put(bench, "drive_target", x_m=10.8)
    bench.iterate()
    assert newest(bench, "navigator_state").distance_m == pytest.approx(reached_m - 10.0)


@pytest.mark.parametrize("heading_rad", [math.nan, math.inf])
def test_blind_robot_that_is_told_no_heading_stands(heading_rad: float) -> None:
    bench = Bench(Navigator, "cyan2/navigator")
    bench.port("world_model").put(localized=False)
    bench.port("blind_drive").put(vx_m_s=1.0, enabled=True)
    bench.iterate()
    assert newest(bench, "motor_command").vx_m_s > 0.0
    for _ in range(40):
        bench.port("world_model").put(localized=True, heading_rad=heading_rad)
        bench.iterate()
        command = newest(bench, "motor_command")
        assert math.isfinite(command.vx_m_s + command.vy_m_s + command.omega_rad_s)
    assert (command.vx_m_s, command.vy_m_s, command.omega_rad_s) == (0.0, 0.0, 0.0)


def test_stopped_navigator_leaves_the_motors_off() -> None:
    bench = navigate(5, x_m=5.0, heading_rad=math.pi / 2)
    bench.finalize()
    command = newest(bench, "motor_command")
    assert (command.enabled, command.vx_m_s, command.vy_m_s, command.omega_rad_s) == (False, 0.0, 0.0, 0.0)


def test_slow_robot_evades_no_faster_than_it_may() -> None:
    bench = Bench(Navigator, "cyan2/navigator", limits={"speed_m_s": 0.5})
    for _ in range(20):
        rival = estimate(1.5, 0.1)
        rival.vx_m_s = -1.5
        put(bench, "world_model", localized=True, opponents=[rival], n_opponents=1)
        put(bench, "odometry")
        put(bench, "drive_target", avoid_robots=True)
        bench.iterate()
    speeds_m_s = [math.hypot(command.vx_m_s, command.vy_m_s) for command in bench.port("motor_command").sent]
    assert max(speeds_m_s) == pytest.approx(0.5)


def test_navigator_counts_on_the_commands_on_their_way() -> None:
    """A robot that stands and was commanded to drive is believed to drive half as fast until it follows."""
    bench = Bench(Navigator, "cyan2/navigator")
    for tick in range(11):
        put(bench, "world_model", localized=True, heading_rad=1.0)
        put(bench, "odometry", vx_m_s=1.0 if tick == 10 else 0.0)
        put(bench, "drive_target", x_m=5.0, heading_rad=1.0)
        bench.iterate()
    driven = Point(math.cos(1.0) * 0.5 + 0.75, math.sin(1.0) * 0.5)
    place = Point(driven.x_m * 0.14, driven.y_m * 0.14)
    assert newest(bench, "navigator_state").distance_m == pytest.approx(math.dist(place, (5.0, 0.0)))


def way(start: Point, late_ticks: int, ticks: int, look: Callable[[Bench, int, Point], None]) -> list[Point]:
    """Returns the places of a robot whose wheels follow a command so many ticks later.

    `look` puts what the robot knows at a tick and a place, but for its odometry.
    """
    bench = Bench(Navigator, "cyan2/navigator")
    places, heading_rad = [start], 0.0
    command, *waiting = (motor_command_t() for _ in range(1 + late_ticks))
    for tick in range(ticks):
        look(bench, tick, places[-1])
        put(bench, "odometry", vx_m_s=command.vx_m_s, vy_m_s=command.vy_m_s)
        bench.iterate()
        waiting.append(newest(bench, "motor_command"))
        command = waiting.pop(0)
        place, heading_rad = moved(places[-1], heading_rad, command)
        places.append(place)
    return places


def nearest_m(places: list[Point]) -> float:
    """Returns how near the places come to the ball, in the middle."""
    return min(math.hypot(*place) for place in places)


def set_piece(bench: Bench, team: int) -> None:
    put(bench, "game_state", state=game_state_t.FREE_KICK, stopped=True, state_team=team)


def at_set_piece(
    team: int, x_m: float, target_x_m: float, rival_x_m: float, ticks: int = 40, late_ticks: int = 0
) -> float:
    """Returns how near a robot comes to the ball of a set piece in the middle, while a rival drives towards it."""

    def look(bench: Bench, tick: int, place: Point) -> None:
        rival = estimate(max(1.0, rival_x_m - 1.5 * 0.05 * tick), 0.05)
        rival.vx_m_s = -1.5
        set_piece(bench, team)
        put(bench, "world_model", localized=True, x_m=place.x_m, y_m=place.y_m, opponents=[rival], n_opponents=1)
        put(bench, "drive_target", x_m=target_x_m, avoid_robots=True)

    return nearest_m(way(Point(x_m, 0.0), late_ticks, ticks, look))


@pytest.mark.parametrize(("team", "least_m"), [(game_state_t.TEAM_CYAN, 2.0), (game_state_t.TEAM_MAGENTA, 3.0)])
def test_robot_that_evades_stays_outside_the_circle(team: int, least_m: float) -> None:
    x_m = least_m + 0.3
    assert at_set_piece(team, x_m, x_m, rival_x_m=x_m + 1.5) >= least_m
    assert at_set_piece(team, x_m, -x_m, rival_x_m=x_m + 9.0, ticks=120, late_ticks=2) >= least_m + 0.1


@pytest.mark.parametrize("turns", [19, 22, 25, 28, 31])
def test_robot_sent_back_on_its_way_stays_outside_the_circle(turns: int) -> None:
    """The robot brakes for the ball of a set piece first, and turns to its new target afterwards."""

    def look(bench: Bench, tick: int, place: Point) -> None:
        x_m, y_m = (-3.0, -3.0) if tick < turns else (-1.0, 2.5)
        set_piece(bench, game_state_t.TEAM_CYAN)
        put(bench, "world_model", localized=True, x_m=place.x_m, y_m=place.y_m)
        put(bench, "drive_target", x_m=x_m, y_m=y_m, avoid_robots=True)

    places = way(Point(6.0, 1.0), 3, 140, look)
    assert nearest_m(places) > 2.1
    assert math.dist(places[-1], (-1.0, 2.5)) < 0.1


def test_taker_is_sent_into_the_circle() -> None:
    assert at_set_piece(game_state_t.TEAM_CYAN, 3.0, 0.75, rival_x_m=20.0, ticks=80) == pytest.approx(0.75, abs=0.1)


def test_robot_sent_to_the_other_side_of_a_ball_does_not_push_it() -> None:
    """On its way to a place beside the ball it gets one on the ball's other side."""

    def look(bench: Bench, tick: int, place: Point) -> None:
        put(bench, "world_model", localized=True, x_m=place.x_m, y_m=place.y_m, ball=ball_estimate_t(known=True))
        put(bench, "drive_target", x_m=-0.27, y_m=0.7 if tick < 28 else -0.7, avoid_ball=True)

    places = way(Point(-2.5, 1.8), 2, 70, look)
    assert nearest_m(places) > 0.38
    assert math.dist(places[-1], (-0.27, -0.7)) < 0.05
