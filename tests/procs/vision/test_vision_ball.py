"""The ball detector against rendered truth: errors by distance, recall, false balls, hidden balls."""

import itertools
import math
from functools import cache

import numpy as np
import pytest

from procs.model.algebra import Floats
from procs.model.expected_errors import EXPECTED
from procs.model.field import Field
from procs.model.robot import ROBOT
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.vision.ball_finder import BallFinder
from procs.vision.colours import BLACK, CYAN, GREEN, MAGENTA, ORANGE, WHITE, Bgr, ColourRange, Hsv, Picture
from procs.vision.mirror import Mirror
from procs.vision.omni_ball import OmniBallConfig

DEFAULTS = OmniBallConfig()
MIRROR = DEFAULTS.mirror.mirror()
STATED = EXPECTED["realistic"]
SHAKE_PX = 0.5
"""Deviation of the mirror of a robot at 1 m/s."""
FINDER = BallFinder(
    MIRROR,
    ColourRange(DEFAULTS.ball_low, DEFAULTS.ball_high),
    deviation_px=STATED.ball_px * (1.0 + STATED.ball_shake_s_m),
)


@cache
def renderer() -> Renderer:
    return Renderer(MIRROR, Field(), Bodies())


@cache
def noise() -> SensorNoise:
    return SensorNoise((MIRROR.size_px, MIRROR.size_px, 3), 5.0, 1.0, 0.0)


def picture(scene: Scene, rng: np.random.Generator, shake_px: float = 0.0) -> Picture:
    right, down = shake_px * rng.standard_normal(2)
    frame = renderer().render(scene, (float(right), float(down)))
    return noise().apply(frame, rng)


def sightings(distance_m: float, shake_px: float, count: int = 40) -> tuple[Floats, Floats, int]:
    """Returns errors (n, 2) along and across the ray, squared errors in units of the covariance, and missed balls."""
    rng = np.random.default_rng(round(distance_m * 100))
    errors, normed, missed = [], [], 0
    for _ in range(count):
        own = Pose(rng.uniform(-3.0, 3.0), rng.uniform(-3.0, 3.0), rng.uniform(-math.pi, math.pi))
        angle = rng.uniform(-math.pi, math.pi)
        ray = np.array([math.cos(angle), math.sin(angle)])
        world = own.heading_rad + angle
        ball_m = (own.x_m + distance_m * math.cos(world), own.y_m + distance_m * math.sin(world), 0.11)
        ball = FINDER.find(picture(Scene(own, [], ball_m), rng, shake_px))
        if ball is None:
            missed += 1
            continue
        error = np.array([ball.x_m, ball.y_m]) - distance_m * ray
        errors.append((error @ ray, error @ (-ray[1], ray[0])))
        normed.append(error @ np.linalg.solve(ball.covariance_m2, error))
    return np.array(errors), np.array(normed), missed


@pytest.mark.parametrize(
    ("distance_m", "most_m"), [(0.5, 0.003), (1.0, 0.003), (2.0, 0.003), (3.0, 0.006), (4.0, 0.01), (6.0, 0.06)]
)
def test_still_ball_is_found_to_a_small_part_of_a_pixel(distance_m: float, most_m: float) -> None:
    errors, _, missed = sightings(distance_m, shake_px=0.0)
    assert missed == 0
    assert math.sqrt((errors**2).sum(axis=1).mean()) < most_m


@pytest.mark.slow
@pytest.mark.parametrize("distance_m", [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
def test_covariance_matches_the_errors_of_a_shaking_mirror(distance_m: float) -> None:
    errors, normed, missed = sightings(distance_m, SHAKE_PX)
    assert missed <= 1
    assert abs(errors.mean(axis=0)[0]) < errors[:, 0].std()
    assert 1.0 < normed.mean() < 3.5  # two degrees of freedom: 2 if the covariance were exact


@pytest.mark.parametrize("radius_m", [0.11, 0.25])
def test_pixels_count_in_the_plane_of_the_balls_middle(radius_m: float) -> None:
    scene = Scene(Pose(0.5, 0.5, 0.0), [], (3.5, 0.5, radius_m))
    frame = Renderer(MIRROR, Field(), Bodies(ball_radius_m=radius_m)).render(scene)
    ball = BallFinder(MIRROR, FINDER.colour, radius_m, deviation_px=0.5).find(frame)
    assert ball is not None
    middle_px = MIRROR.project(np.array([(ball.x_m, ball.y_m, radius_m)]))
    nearer_m, further_m = MIRROR.ground(middle_px + np.array([(0.0, 0.5), (0.0, -0.5)]), radius_m)[:, 0]
    assert math.sqrt(ball.covariance_m2[0, 0]) == pytest.approx((further_m - nearer_m) / 2, rel=0.03)


def test_error_grows_with_distance_as_cambada_assumes_at_most() -> None:
    """CAMBADA's filter uses 0.01 d² - 0.01 d + 0.039 m as the standard deviation of a single sighting."""
    deviations = [math.sqrt((sightings(d, SHAKE_PX)[0] ** 2).sum(axis=1).mean()) for d in (1.0, 2.0, 4.0, 6.0)]
    assert deviations == sorted(deviations)
    for distance_m, deviation_m in zip((1.0, 2.0, 4.0, 6.0), deviations, strict=True):
        assert deviation_m < 0.01 * distance_m**2 - 0.01 * distance_m + 0.039


def crowd(rng: np.random.Generator, own: Pose) -> list[tuple[float, float, Bgr]]:
    robots: list[tuple[float, float, Bgr]] = []
    while len(robots) < 9:
        x_m, y_m = float(rng.uniform(-11.0, 11.0)), float(rng.uniform(-7.0, 7.0))
        if all(math.hypot(x_m - x, y_m - y) > 0.52 for x, y in [(own.x_m, own.y_m), *((r[0], r[1]) for r in robots)]):
            robots.append((x_m, y_m, MAGENTA if len(robots) % 2 else CYAN))
    return robots


def test_lines_robots_goals_and_surroundings_show_no_ball() -> None:
    rng = np.random.default_rng(5)
    for _ in range(150):
        own = Pose(rng.uniform(-11.0, 11.0), rng.uniform(-7.0, 7.0), rng.uniform(-math.pi, math.pi))
        assert FINDER.find(picture(Scene(own, crowd(rng, own), None), rng)) is None


def test_nearly_every_ball_in_a_crowd_is_found() -> None:
    rng = np.random.default_rng(6)
    found = balls = 0
    for _ in range(150):
        own = Pose(rng.uniform(-11.0, 11.0), rng.uniform(-7.0, 7.0), rng.uniform(-math.pi, math.pi))
        robots, distance_m, angle = crowd(rng, own), rng.uniform(0.4, 5.0), rng.uniform(-math.pi, math.pi)
        x_m, y_m = own.x_m + distance_m * math.cos(angle), own.y_m + distance_m * math.sin(angle)
        if any(math.hypot(x_m - robot[0], y_m - robot[1]) < 0.36 for robot in robots):
            continue
        balls += 1
        ball = FINDER.find(picture(Scene(own, robots, (x_m, y_m, 0.11)), rng))
        if ball is not None:
            found += 1
            seen = angle - own.heading_rad
            error_m = math.hypot(ball.x_m - distance_m * math.cos(seen), ball.y_m - distance_m * math.sin(seen))
            assert error_m < 0.05 + 0.1 * distance_m  # half-hidden balls are off by a part of their size
    assert found / balls >= 0.9


def test_ball_behind_a_robot_is_not_seen() -> None:
    own = Pose(-3.0, 2.0, 0.0)
    assert FINDER.find(renderer().render(Scene(own, [(-2.0, 2.0, CYAN)], (-1.2, 2.0, 0.11)))) is None


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("distance_m", [0.7, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("visible", [0.5, 0.7, 0.9])
def test_half_hidden_ball_is_found_where_it_lies(distance_m: float, visible: float, side: float) -> None:
    """The middle of what is seen is up to 4 cm further from the robot that hides the rest."""
    rng, left_m, normed = np.random.default_rng(round(100 * distance_m)), [], []
    edge_m = {0.5: 0.0, 0.7: 0.035, 0.9: 0.075}[visible]  # so far beside the ball's middle the hidden part begins
    robot_m = 0.6 * distance_m
    beside_m = side * (math.hypot(robot_m, ROBOT.radius_m) * math.asin(edge_m / distance_m) + ROBOT.radius_m)
    for _ in range(20):
        scene = Scene(Pose(0.5, 2.0, 0.0), [(0.5 + robot_m, 2.0 + beside_m, MAGENTA)], (0.5 + distance_m, 2.0, 0.11))
        ball = FINDER.find(picture(scene, rng))
        assert ball is not None
        assert ball.confidence == pytest.approx(visible, abs=0.12)
        left_m.append(ball.y_m)
        error_m = np.array((ball.x_m - distance_m, ball.y_m))
        normed.append(float(error_m @ np.linalg.solve(ball.covariance_m2, error_m)))
    assert abs(np.mean(left_m)) < 0.004
    assert np.mean(normed) < 2.0


def test_ball_hidden_from_both_sides_is_less_certain() -> None:
    own, ball_m, rng = Pose(-3.0, 2.0, 0.0), (0.0, 2.0, 0.11), np.random.default_rng(1)
    left, right = (-1.2, 2.288, CYAN), (-1.2, 1.712, MAGENTA)
    whole, one_side, both_sides = (
        FINDER.find(picture(Scene(own, robots, ball_m), rng)) for robots in ([], [left], [left, right])
    )
    assert whole is not None
    assert one_side is not None
    assert both_sides is not None
    assert both_sides.confidence < one_side.confidence < whole.confidence
    assert one_side.covariance_m2[1, 1] < 1.5 * whole.covariance_m2[1, 1]
    assert both_sides.covariance_m2[1, 1] > 3 * whole.covariance_m2[1, 1]
    assert both_sides.y_m**2 < 2 * both_sides.covariance_m2[1, 1]


@pytest.mark.parametrize(
    ("distance_m", "height_m", "missed"),
    [
        *itertools.product((1.0, 3.0), (0.1, 0.3, 0.5), (0,)),
        (3.0, 0.8, 0),
        (5.0, 0.1, 2),
        (5.0, 0.3, 3),
        (5.0, 0.5, 0),
        (5.0, 0.8, 0),
        (7.0, 0.8, 0),
        (7.0, 1.1, 0),
    ],
)
def test_ball_in_the_air_is_found_at_its_height(distance_m: float, height_m: float, missed: int) -> None:
    """`missed` balls of 60 may not be found."""
    rng, normed = np.random.default_rng(round(100 * distance_m)), []
    for _ in range(60):
        angle = rng.uniform(-math.pi, math.pi)
        place_m = distance_m * np.array((math.cos(angle), math.sin(angle)))
        ball_m = (place_m[0] - 1.0, place_m[1] + 2.0, height_m + 0.11)
        ball = FINDER.find(picture(Scene(Pose(-1.0, 2.0, 0.0), [], ball_m), rng, SHAKE_PX))
        if ball is None:
            continue
        assert ball.z_m == pytest.approx(height_m, abs=0.04 + 0.015 * distance_m)
        error = np.array((ball.x_m, ball.y_m)) - place_m
        normed.append(error @ np.linalg.solve(ball.covariance_m2, error))
    assert len(normed) >= 60 - missed
    assert 0.3 < np.mean(normed) / 2 < 1.8


def test_size_of_a_half_hidden_ball_in_the_air_is_not_trusted() -> None:
    rng, normed = np.random.default_rng(4), []
    for _ in range(80):
        distance_m, share, aside_m = rng.uniform(1.5, 4.0), rng.uniform(0.4, 0.8), rng.uniform(-0.4, 0.4)
        robot = (share * distance_m - 1.0, aside_m + 2.0, CYAN)
        ball_m = (distance_m - 1.0, 2.0, 0.36)
        ball = FINDER.find(picture(Scene(Pose(-1.0, 2.0, 0.0), [robot], ball_m), rng, SHAKE_PX))
        if ball is not None and ball.z_m > 0.0:
            error = np.array((ball.x_m - distance_m, ball.y_m))
            normed.append(error @ np.linalg.solve(ball.covariance_m2, error))
    assert len(normed) > 20
    assert np.mean(normed) / 2 < 2.0  # several dozens if its size were taken for that of a whole ball


def test_ball_that_the_pictures_edge_cuts_is_not_seen() -> None:
    ball_m = (0.0, 2.0, 0.81)  # its centre is above the horizon, its upper half above the mirror's edge
    assert FINDER.find(renderer().render(Scene(Pose(-1.0, 2.0, 0.0), [], ball_m))) is None


def test_ball_on_the_ground_never_seems_to_fly() -> None:
    rng = np.random.default_rng(11)
    for _ in range(150):
        distance_m, angle = rng.uniform(0.4, 7.0), rng.uniform(-math.pi, math.pi)
        ball_m = (distance_m * math.cos(angle) - 1.0, distance_m * math.sin(angle) + 2.0, 0.11)
        ball = FINDER.find(picture(Scene(Pose(-1.0, 2.0, 0.0), [], ball_m), rng, SHAKE_PX))
        assert ball is None or ball.z_m == 0.0


@pytest.mark.parametrize("brightness", [0.6, 1.0, 1.3])
def test_brightness_does_not_matter(brightness: float) -> None:
    rng = np.random.default_rng(8)
    frame = renderer().render(Scene(Pose(-3.0, 2.0, 0.4), [(1.0, 2.0, CYAN)], (-1.0, 1.0, 0.11)))
    ball = FINDER.find(SensorNoise((MIRROR.size_px, MIRROR.size_px, 3), 5.0, brightness, 0.0).apply(frame, rng))
    assert ball is not None
    assert math.hypot(ball.x_m, ball.y_m) == pytest.approx(math.hypot(2.0, 1.0), abs=0.01)


@pytest.mark.parametrize("colour", [BLACK, WHITE, ORANGE, CYAN, MAGENTA])
def test_picture_of_one_colour_shows_no_ball(colour: Bgr) -> None:
    assert FINDER.find(np.full((400, 400, 3), colour, np.uint8)) is None


def test_pure_noise_shows_no_ball() -> None:
    rng = np.random.default_rng(9)
    for _ in range(20):
        assert FINDER.find(rng.integers(0, 256, (400, 400, 3), dtype=np.uint8)) is None
        grey = rng.integers(0, 256, (400, 400, 1), dtype=np.uint8)
        assert FINDER.find(np.repeat(grey, 3, axis=2)) is None


def test_stripe_with_a_balls_area_is_no_ball() -> None:
    _, row, radius_px = MIRROR.sphere((2.0, 0.0, 0.11), 0.11)
    top, centre = round(row), round(MIRROR.centre_px)
    half_px = round(math.pi * radius_px**2 / 8)
    frame = np.full((400, 400, 3), GREEN, np.uint8)
    frame[top - 2 : top + 2, centre - half_px : centre + half_px] = ORANGE
    assert FINDER.find(frame) is None
    frame[:] = GREEN
    side_px = round(math.sqrt(math.pi) * radius_px / 2)
    frame[top - side_px : top + side_px, centre - side_px : centre + side_px] = ORANGE
    assert FINDER.find(frame) is not None  # so the shape made the difference


def test_all_things_like_a_ball_are_found_the_likelier_earlier() -> None:
    frame = renderer().render(Scene(Pose(-1.0, 2.0, 0.0), [], (1.0, 2.0, 0.11)))
    column, row, radius_px = MIRROR.sphere((0.0, 3.0, 0.11), 0.09)  # a smaller ball, so a less likely one
    rows, columns = np.mgrid[: MIRROR.size_px, : MIRROR.size_px]
    frame[np.hypot(columns - column, rows - row) < radius_px] = ORANGE
    likely, unlikely = FINDER.find_all(frame)
    assert (likely.x_m, likely.y_m) == pytest.approx((2.0, 0.0), abs=0.05)
    assert (unlikely.x_m, unlikely.y_m) == pytest.approx((0.0, 3.0), abs=0.3)
    assert likely.confidence > unlikely.confidence


def test_odd_picture_size_works_as_well() -> None:
    mirror = Mirror(size_px=331)
    frame = Renderer(mirror, Field(), Bodies()).render(Scene(Pose(-3.0, 2.0, 0.0), [], (-1.0, 2.5, 0.11)))
    ball = BallFinder(mirror, FINDER.colour).find(frame)
    assert ball is not None
    assert (ball.x_m, ball.y_m) == pytest.approx((2.0, 0.5), abs=0.01)


@pytest.mark.parametrize(
    ("colour", "low", "high"),
    [
        ((200, 60, 20), (105, 120, 80), (125, 255, 255)),  # blue
        ((230, 230, 230), (0, 0, 200), (179, 40, 255)),
        ((20, 220, 230), (25, 120, 80), (35, 255, 255)),  # yellow
    ],
)
def test_ball_of_another_colour_is_found(colour: Bgr, low: Hsv, high: Hsv) -> None:
    rng = np.random.default_rng(12)
    column, row, radius_px = MIRROR.sphere((2.0, 0.5, 0.11), 0.11)
    rows, columns = np.mgrid[:400, :400]
    frame = np.full((400, 400, 3), GREEN, np.uint8)
    frame[np.hypot(columns - column, rows - row) < radius_px] = colour
    ball = BallFinder(MIRROR, ColourRange(low, high)).find(noise().apply(frame, rng))
    assert ball is not None
    assert (ball.x_m, ball.y_m, ball.z_m) == pytest.approx((2.0, 0.5, 0.0), abs=0.03)
