"""Robots and ball that are put down: always inside the walls, and clear of each other and of the goals."""

import math

import pytest

from fwk.testing import Bench, MemorySystem, system_of
from lcmtypes.core import answer_t
from lcmtypes.soccer import ground_truth_t, place_ball_t, place_robot_t, referee_command_t
from procs.model.ball import BALL
from procs.model.field import SIDES, Field, Point
from procs.model.robot import ROBOT
from procs.simulation.physics.room import Room
from procs.simulation.simulator import Simulator

FIELD = Field()
SMALL = Field(
    length_m=9.0,
    width_m=6.0,
    restart_offset_m=1.0,
    penalty_mark_distance_m=1.8,
    penalty_area_width_m=3.5,
    penalty_area_depth_m=1.2,
    goal_area_width_m=2.6,
    goal_area_depth_m=0.5,
    goal_width_m=1.5,
)
APART_M = ROBOT.radius_m + BALL.radius_m
WALL_X_M, WALL_Y_M = FIELD.half_length_m + FIELD.border_m, FIELD.half_width_m + FIELD.border_m
CORNERS = [(11.9, 7.9), (-11.9, 7.9), (12.0, 0.0), (0.0, -8.0)]
GOALS = [(11.0, 1.26), (-11.6, 1.2), (11.62, 0.0), (-11.3, -1.27)]


def world_of(
    *messages: place_robot_t | place_ball_t, robots: tuple[str, ...] = ("cyan",)
) -> tuple[MemorySystem, ground_truth_t]:
    """Returns a match of some robots, led by hand, and its truth after the commands, carried out one a tick.

    The robots have no agents; `robots` are beginnings of their names.
    """
    by_hand = ["world/referee.automatic=false"]  # otherwise fouls of the robots would have the ball put elsewhere
    parts = ("world/", *robots)
    system = system_of(
        "soccer-truth.yaml", lambda name: name.startswith(parts) and not name.endswith("/agent"), sets=by_hand
    )
    system.come_in("world/referee_command@outside", referee_command_t(name="start"))
    system.tick(4)
    for message in messages:
        system.come_in(f"world/{type(message).__name__.removesuffix('_t')}@outside", message)
        system.tick()
    return system, system.newest("world/ground_truth")


def places_of(truth: ground_truth_t) -> dict[str, tuple[float, float]]:
    return {robot.name: (robot.x_m, robot.y_m) for robot in truth.robots} | {"ball": (truth.ball_x_m, truth.ball_y_m)}


def assert_clear(truth: ground_truth_t) -> None:
    """Checks that no two bodies overlap and that none overlaps walls, posts or nets."""
    places = places_of(truth)
    ball = places.pop("ball")
    slack_m = 1e-3
    for name, (x_m, y_m) in [*places.items(), ("ball", ball)]:
        radius_m = BALL.radius_m if name == "ball" else ROBOT.radius_m
        assert abs(x_m) + radius_m <= WALL_X_M + slack_m, name
        assert abs(y_m) + radius_m <= WALL_Y_M + slack_m, name
        for side in SIDES:
            for post in FIELD.goal_posts(side):
                away_m = math.dist((x_m, y_m), post)
                assert away_m >= radius_m + FIELD.post_diameter_m / 2 - slack_m, f"{name} at a post"
    for name, place in places.items():
        assert math.dist(place, ball) >= APART_M - slack_m, f"{name} on the ball"
        others = [other for each, other in places.items() if each != name]
        assert min(math.dist(place, other) for other in others) >= 2 * ROBOT.radius_m - slack_m, name


@pytest.mark.parametrize("place", [*CORNERS, *GOALS])
def test_ball_beside_a_robot_stays_inside_the_walls(place: tuple[float, float]) -> None:
    x_m, y_m = place
    robot = place_robot_t(robot="cyan2", x_m=0.975 * x_m, y_m=0.97 * y_m)
    system, truth = world_of(robot, place_ball_t(x_m=x_m, y_m=y_m))
    assert_clear(truth)
    assert math.dist(places_of(truth)["ball"], place) < 1.0
    before = places_of(truth)
    system.tick(25)
    for name, now in places_of(system.newest("world/ground_truth")).items():
        assert math.dist(now, before[name]) < 2e-3, f"{name} is pushed away"


@pytest.mark.parametrize("place", [*CORNERS, *GOALS])
def test_robot_at_a_wall_or_goal_stands_clear(place: tuple[float, float]) -> None:
    _, truth = world_of(
        place_ball_t(x_m=place[0], y_m=place[1]), place_robot_t(robot="cyan3", x_m=place[0], y_m=place[1])
    )
    assert_clear(truth)
    assert math.dist(places_of(truth)["cyan3"], place) < 1.0


def test_robots_at_one_place_stand_beside_each_other() -> None:
    names = ["cyan2", "cyan3", "cyan4", "cyan5", "magenta2", "magenta3"]
    _, truth = world_of(*(place_robot_t(robot=name, x_m=3.0, y_m=3.0) for name in names), robots=("cyan", "magenta"))
    assert_clear(truth)
    assert max(math.dist(places_of(truth)[name], (3.0, 3.0)) for name in names) < 1.2


def test_free_place_is_taken_as_it_is() -> None:
    _, truth = world_of(place_robot_t(robot="cyan2", x_m=11.75, y_m=5.0), place_ball_t(x_m=11.89, y_m=-7.89))
    assert places_of(truth)["cyan2"] == pytest.approx((11.75, 5.0))
    assert places_of(truth)["ball"] == pytest.approx((11.89, -7.89))


@pytest.mark.parametrize(
    ("port", "values", "reason"),
    [
        ("place_robot", {"robot": "cyan1"}, "there is no room left for cyan1 between the walls"),
        ("place_ball", {}, "there is no room left for the ball between the walls"),
    ],
)
def test_command_without_room_is_refused(
    port: str, values: dict[str, object], reason: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    world = Bench(Simulator, name="world/simulator", namespaces=("cyan1", "magenta1"), realism="none")
    world.iterate()
    before = places_of(world.port("ground_truth").sent[-1])
    monkeypatch.setattr(Room, "is_free", lambda *_: False)
    world.port(port).put(**values)
    world.iterate()
    answer = world.port(port).sent[-1].answer
    assert (answer.state, answer.reason) == (answer_t.REJECTED, reason)
    assert places_of(world.port("ground_truth").sent[-1]) == before


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (0.1, 0.0, 1.0), (-0.2, 0.1, 0.0)])
def test_match_begins_with_the_ball_outside_of_robots(start: tuple[float, float, float]) -> None:
    world = Bench(Simulator, name="world/simulator", namespaces=("cyan1",), realism="none", starts={"cyan1": start})
    for _ in range(3):
        world.iterate()
        truth = world.port("ground_truth").sent[-1]
        assert math.dist((truth.ball_x_m, truth.ball_y_m), start[:2]) >= APART_M
        assert (truth.ball_vx_m_s, truth.ball_vy_m_s) == (0.0, 0.0)
    assert world.port("match_events").sent[-1].ball_in_field


def test_ball_in_the_mouth_of_a_starting_robot_stays_there() -> None:
    mouth_m = ROBOT.mouth_m + BALL.radius_m
    starts = {"cyan1": (-mouth_m, 0.0, 0.0)}
    world = Bench(Simulator, name="world/simulator", namespaces=("cyan1",), realism="none", starts=starts)
    world.iterate()
    assert world.port("ground_truth").sent[-1].ball_x_m == pytest.approx(0.0, abs=1e-3)
    assert world.port("kicker_sensor", "cyan1").sent[-1].ball_held


def test_full_ground_has_no_free_place() -> None:
    room = Room(SMALL)
    robots = [Point(0.5 * column, 0.5 * row) for column in range(-11, 12) for row in range(-8, 9)]
    assert room.nearest(Point(1.0, 1.0), BALL.radius_m, robots, APART_M) is None
    robots.remove(Point(-4.0, 3.0))
    assert room.nearest(Point(1.0, 1.0), BALL.radius_m, robots, APART_M) == pytest.approx((-4.0, 3.0), abs=0.2)


def test_place_on_a_ring_is_taken_if_it_is_nearer() -> None:
    """Two robots push a third away one after the other, 0.47 m far."""
    robots = [Point(0.15, 0.2), Point(-0.25, -0.1), Point(0.05, -1.05)]
    place = Room(FIELD).nearest(Point(0.0, 0.0), ROBOT.radius_m, robots, 2 * ROBOT.radius_m)
    assert place is not None
    assert math.hypot(*place) < 0.38


def test_place_beside_a_robot_is_taken_if_it_is_nearer() -> None:
    place = Room(FIELD).nearest(Point(0.1, 0.0), BALL.radius_m, [Point(0.0, 0.0)], APART_M)
    assert place == pytest.approx((APART_M, 0.0))


@pytest.mark.parametrize(("vz_m_s", "rises"), [(-5.0, True), (-0.5, False), (-0.001, False)])
def test_ball_thrown_at_the_ground_bounces_or_lies(vz_m_s: float, rises: bool) -> None:
    system, truth = world_of(place_ball_t(x_m=1.0, y_m=1.0, vz_m_s=vz_m_s), robots=("cyan1",))
    heights_m, speeds_m_s = [truth.ball_z_m], [truth.ball_vz_m_s]
    for _ in range(75):
        system.tick()
        truth = system.newest("world/ground_truth")
        heights_m.append(truth.ball_z_m)
        speeds_m_s.append(truth.ball_vz_m_s)
    assert (max(heights_m) > 0.3) is rises
    assert all(speed >= 0.0 for height, speed in zip(heights_m, speeds_m_s, strict=True) if height == 0.0)
    assert (heights_m[-1], speeds_m_s[-1]) == (0.0, 0.0)
