"""Line points and obstacles against rendered truth."""

import math
from functools import cache

import numpy as np
import pytest

from procs.model.algebra import Floats
from procs.model.expected_errors import EXPECTED
from procs.model.field import Arc, Field, Segment
from procs.simulation.rendering.renderer import Pose, Renderer, Scene
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.rendering.shapes import Bodies
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import BLACK, CYAN, GREEN, MAGENTA, WHITE, Bgr, ColourRange, Picture, to_hsv
from procs.vision.line_finder import LineFinder
from procs.vision.obstacle_finder import Obstacle, ObstacleFinder
from procs.vision.omni_field import OmniFieldConfig
from procs.vision.scan import Scan, runs

DEFAULTS = OmniFieldConfig()
MIRROR = DEFAULTS.mirror.mirror()
GREENS = ColourRange(DEFAULTS.green_low, DEFAULTS.green_high)
WHITES = ColourRange(DEFAULTS.white_low, DEFAULTS.white_high)
BLACKS = ColourRange(DEFAULTS.black_low, DEFAULTS.black_high)
STAR = Scan.star(MIRROR, DEFAULTS.rays, 0.28, DEFAULTS.farthest_m)
RINGS = Scan.rings(MIRROR, DEFAULTS.ring_distances_m)
LINES = LineFinder(GREENS, WHITES)
OBSTACLES = ObstacleFinder(MIRROR, STAR, BLACKS, (GREENS, WHITES), deviation_px=EXPECTED["realistic"].robot_px)
FIELD = Field()


@cache
def renderer() -> Renderer:
    return Renderer(MIRROR, FIELD, Bodies())


@cache
def noise() -> SensorNoise:
    return SensorNoise((MIRROR.size_px, MIRROR.size_px, 3), 5.0, 1.0, 0.0)


def picture(scene: Scene, rng: np.random.Generator, shake_px: float = 0.0) -> Picture:
    right, down = shake_px * rng.standard_normal(2)
    return noise().apply(renderer().render(scene, (float(right), float(down))), rng)


def line_points(frame: Picture) -> Floats:
    return np.vstack([LINES.find(to_hsv(scan.look_up(frame)), scan) for scan in (STAR, RINGS)])


def obstacles(frame: Picture) -> list[Obstacle]:
    return OBSTACLES.find(to_hsv(STAR.look_up(frame)))


def distance_to_segment(points_m: Floats, segment: Segment) -> Floats:
    start, end = np.array(segment.start), np.array(segment.end)
    along = ((points_m - start) @ (end - start) / ((end - start) @ (end - start))).clip(0.0, 1.0)
    return np.asarray(np.linalg.norm(points_m - start - along[:, None] * (end - start), axis=1))


def distance_to_arc(points_m: Floats, arc: Arc) -> Floats:
    offsets = points_m - np.array(arc.centre)
    angles = (np.arctan2(offsets[:, 1], offsets[:, 0]) - arc.start_rad) % (2 * math.pi)
    distances = np.abs(np.linalg.norm(offsets, axis=1) - arc.radius_m)
    return np.where(angles <= arc.end_rad - arc.start_rad, distances, np.inf)


def distance_to_lines(points_m: Floats) -> Floats:
    """Returns distances from points (n, 2) in the world frame to the middle of the nearest line or mark."""
    distances = np.min(
        [distance_to_segment(points_m, segment) for segment in FIELD.segments()]
        + [distance_to_arc(points_m, arc) for arc in FIELD.arcs()]
        + [np.linalg.norm(points_m - np.array(mark), axis=1) for mark in FIELD.marks()],
        axis=0,
    )
    return np.asarray(distances)


def to_world(points_m: Floats, own: Pose) -> Floats:
    cosine, sine = math.cos(own.heading_rad), math.sin(own.heading_rad)
    return np.asarray(points_m @ np.array([[cosine, sine], [-sine, cosine]]) + (own.x_m, own.y_m))


def crowd(rng: np.random.Generator, own: Pose, count: int = 9) -> list[tuple[float, float, Bgr]]:
    robots: list[tuple[float, float, Bgr]] = []
    while len(robots) < count:
        x_m, y_m = float(rng.uniform(-11.0, 11.0)), float(rng.uniform(-7.0, 7.0))
        if all(math.hypot(x_m - x, y_m - y) > 0.52 for x, y in [(own.x_m, own.y_m), *((r[0], r[1]) for r in robots)]):
            robots.append((x_m, y_m, MAGENTA if len(robots) % 2 else CYAN))
    return robots


def anywhere(rng: np.random.Generator) -> Pose:
    return Pose(rng.uniform(-11.0, 11.0), rng.uniform(-7.0, 7.0), rng.uniform(-math.pi, math.pi))


def test_runs_are_found_at_both_ends_and_never_across_lines() -> None:
    mask = np.array([[1, 1, 0, 1], [1, 0, 0, 0], [0, 0, 0, 0], [0, 1, 1, 1]], np.bool_)
    lines, starts, ends = runs(mask)
    assert list(zip(lines.tolist(), starts.tolist(), ends.tolist(), strict=True)) == [
        (0, 0, 2),
        (0, 3, 4),
        (1, 0, 1),
        (3, 1, 4),
    ]


def test_line_points_lie_on_lines_wherever_the_robot_stands() -> None:
    rng = np.random.default_rng(1)
    distances, far, counts = [], [], []
    for _ in range(100):
        own = anywhere(rng)
        points = line_points(picture(Scene(own, crowd(rng, own), None), rng))
        counts.append(len(points))
        distances.append(distance_to_lines(to_world(points, own)))
        far.append(np.hypot(*points.T))
    errors_m, away_m = np.concatenate(distances), np.concatenate(far)
    assert min(counts) >= 20
    assert np.median(counts) >= 80
    assert np.mean(errors_m > 0.15) < 0.01  # the rest are at corners, where chords end on two lines
    for near_m, most_m in ((0.0, 0.03), (1.0, 0.04), (2.0, 0.06), (4.0, 0.08)):
        band = (away_m >= near_m) & (away_m < near_m + 1.0)
        assert np.percentile(errors_m[band], 95) < most_m + 0.03
        assert math.sqrt(np.mean(np.minimum(errors_m[band], 0.15) ** 2)) < most_m


def test_line_towards_the_robot_is_found_by_the_rings() -> None:
    own = Pose(0.0, 4.5, 0.0)  # on the halfway line, which no ray crosses
    points = LINES.find(to_hsv(RINGS.look_up(renderer().render(Scene(own, [], None)))), RINGS)
    on_halfway_line = np.abs(points[:, 0]) < 0.06
    assert on_halfway_line.sum() >= 10


@pytest.mark.parametrize(("width_m", "rays"), [(0.013, 0), (0.125, DEFAULTS.rays), (0.3, DEFAULTS.rays), (0.6, 0)])
def test_only_structures_as_wide_as_a_line_count(width_m: float, rays: int) -> None:
    """White rings around the robot are crossed by every ray."""
    radius_px = np.hypot(*(np.indices((400, 400)) - MIRROR.centre_px))
    frame = np.full((400, 400, 3), GREEN, np.uint8)
    frame[(radius_px >= MIRROR.radius_px(0.7)) & (radius_px < MIRROR.radius_px(0.7 + width_m))] = WHITE
    assert len(LINES.find(to_hsv(STAR.look_up(frame)), STAR)) == pytest.approx(rays, abs=2)


def test_robots_goals_and_surroundings_give_no_line_points() -> None:
    """A line point has green on both sides, unlike a robot's marker, a goal post and the floor."""
    carpet_only = Field(line_width_m=0.021, mark_diameter_m=0.021)  # lines too thin to be drawn
    bare = Renderer(MIRROR, carpet_only, Bodies())
    rng = np.random.default_rng(2)
    for _ in range(20):
        own = anywhere(rng)
        robots = crowd(rng, own)
        with_robots = line_points(bare.render(Scene(own, robots, None)))
        without = line_points(bare.render(Scene(own, [], None)))
        assert len(with_robots) <= len(without)


def test_robots_are_found_with_small_errors_and_without_ghosts() -> None:
    rng = np.random.default_rng(3)
    errors: dict[int, list[float]] = {}
    visible = found = 0
    for _ in range(120):
        own = anywhere(rng)
        robots = crowd(rng, own)
        seen = obstacles(picture(Scene(own, robots, None), rng, shake_px=0.3))
        left = np.array([robot[:2] for robot in robots])
        for place in to_world(np.array([[o.x_m, o.y_m] for o in seen]).reshape(-1, 2), own):
            nearest = int(np.argmin(np.linalg.norm(left - place, axis=1)))
            away_m = math.hypot(left[nearest, 0] - own.x_m, left[nearest, 1] - own.y_m)
            error_m = float(np.linalg.norm(left[nearest] - place))
            assert error_m < max(0.5, 0.2 * away_m), "a ghost"
            errors.setdefault(int(away_m), []).append(error_m)
            found += away_m < 4.0
        visible += sum(math.hypot(robot[0] - own.x_m, robot[1] - own.y_m) < 4.0 for robot in robots)
    assert found / visible >= 0.9  # some are hidden behind others
    for metres, most_m in ((0, 0.04), (1, 0.04), (2, 0.06), (3, 0.09), (4, 0.12)):
        assert math.sqrt(np.mean(np.square(errors[metres]))) < most_m


def test_robots_seen_from_afar_are_unbiased_on_average() -> None:
    rng = np.random.default_rng(4)
    errors_m = []
    for _ in range(80):
        angle, distance_m = rng.uniform(-math.pi, math.pi), rng.uniform(4.0, 5.0)
        robot = (-4.0 + distance_m * math.cos(angle), 1.0 + distance_m * math.sin(angle), CYAN)
        (found,) = obstacles(renderer().render(Scene(Pose(-4.0, 1.0, 0.0), [robot], None)))
        errors_m.append(math.hypot(found.x_m, found.y_m) - distance_m)
    assert abs(np.mean(errors_m)) < 0.03  # half a pixel would be 0.08 m


def test_obstacle_covariance_is_honest() -> None:
    rng = np.random.default_rng(4)
    normed = []
    for _ in range(150):
        own, angle, distance_m = Pose(-4.0, 1.0, 0.0), rng.uniform(-math.pi, math.pi), rng.uniform(1.0, 5.0)
        truth = distance_m * np.array([math.cos(angle), math.sin(angle)])
        robot = (own.x_m + truth[0], own.y_m + truth[1], CYAN)
        (found,) = obstacles(picture(Scene(own, [robot], None), rng, shake_px=0.5))
        error = np.array([found.x_m, found.y_m]) - truth
        normed.append(error @ np.linalg.solve(found.covariance_m2, error))
    assert 0.7 < np.mean(normed) < 3.0  # two degrees of freedom: 2 if the covariance were exact


@pytest.mark.parametrize(("size_px", "rays"), [(400, 90), pytest.param(1200, 180, marks=pytest.mark.slow), (400, 720)])
def test_covariance_tells_how_far_the_rays_are_apart(size_px: int, rays: int) -> None:
    mirror = MirrorConfig(size_px=size_px).mirror()
    star = Scan.star(mirror, rays, 0.28, DEFAULTS.farthest_m)
    finder = ObstacleFinder(mirror, star, BLACKS, (GREENS, WHITES), deviation_px=EXPECTED["realistic"].robot_px)
    drawn, rng, normed = Renderer(mirror, FIELD, Bodies()), np.random.default_rng(5), []
    for _ in range(30):
        angle, distance_m = rng.uniform(-math.pi, math.pi), rng.uniform(1.0, 3.5)
        truth = distance_m * np.array([math.cos(angle), math.sin(angle)])
        scene = Scene(Pose(-4.0, 1.0, 0.0), [(-4.0 + truth[0], 1.0 + truth[1], CYAN)], None)
        (found,) = finder.find(to_hsv(star.look_up(drawn.render(scene))))
        error = np.array([found.x_m, found.y_m]) - truth
        normed.append(error @ np.linalg.solve(found.covariance_m2, error))
    assert np.mean(normed) < 3.0


def test_two_robots_side_by_side_are_two_obstacles() -> None:
    robots = [(-1.0, 2.26, CYAN), (-1.0, 1.74, MAGENTA)]
    found = obstacles(renderer().render(Scene(Pose(-3.0, 2.0, 0.0), robots, None)))
    places = sorted((o.y_m, o.x_m) for o in found)
    assert np.allclose(places, [(-0.26, 2.0), (0.26, 2.0)], atol=0.08)


@pytest.mark.parametrize("away_m", [1.0, 2.0, 3.0, 4.0])
def test_robots_a_narrow_gap_apart_are_two_obstacles(away_m: float) -> None:
    rng, counts = np.random.default_rng(3), []
    for apart_m in (0.7, 0.75, 0.8, 0.85, 0.9):
        for bearing_rad in np.linspace(0.0, 0.035, 4):  # the angle between two rays
            aside = apart_m / 2 * np.array((-math.sin(bearing_rad), math.cos(bearing_rad)))
            middle = away_m * np.array((math.cos(bearing_rad), math.sin(bearing_rad))) + (-3.0, 2.0)
            others = [(*(middle + side * aside), CYAN) for side in (-1.0, 1.0)]
            counts.append(len(obstacles(picture(Scene(Pose(-3.0, 2.0, 0.0), others, None), rng))))
    assert counts.count(2) >= len(counts) - 1


def test_ball_before_one_of_two_touching_robots_adds_none() -> None:
    """The ball hides the inner or the outer side of a robot, or its middle."""
    robots = [(-1.0, 2.26, CYAN), (-1.0, 1.74, MAGENTA)]
    for y_m in np.linspace(2.1, 2.5, 9):
        ball_m = (-1.0 - math.sqrt(max(0.33**2 - (y_m - 2.26) ** 2, 0.0)), y_m, 0.11)
        assert len(obstacles(renderer().render(Scene(Pose(-3.0, 2.0, 0.0), robots, ball_m)))) <= 2


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize("bearing_rad", [0.3, math.pi])  # the rays begin and end at 0
def test_robot_half_hidden_by_another_is_not_drawn_aside(side: float, bearing_rad: float) -> None:
    own, normed = Pose(-4.0, 1.0, 0.0), []
    for step in range(12):
        near_m, far_m = 1.2 + 0.08 * step, 2.6 + 0.05 * step
        apart_rad = 1.1 * math.asin(0.25 / near_m) * side  # the near one hides nearly half of the far one
        near, far = (
            distance_m * np.array((math.cos(angle), math.sin(angle)))
            for distance_m, angle in ((near_m, bearing_rad), (far_m, bearing_rad + apart_rad))
        )
        others = [(own.x_m + at[0], own.y_m + at[1], CYAN) for at in (near, far)]
        found = obstacles(renderer().render(Scene(own, others, None)))
        error, covariance_m2 = min(
            ((np.array((each.x_m, each.y_m)) - far, each.covariance_m2) for each in found),
            key=lambda pair: float(np.hypot(*pair[0])),
        )
        assert np.hypot(*error) < 0.15
        normed.append(error @ np.linalg.solve(covariance_m2, error))
    assert np.mean(normed) < 3.0


def test_ball_before_a_robot_does_not_split_it() -> None:
    scene = Scene(Pose(-3.0, 2.0, 0.0), [(-1.0, 2.0, CYAN)], (-1.37, 2.0, 0.11))
    (found,) = obstacles(renderer().render(scene))
    assert (found.x_m, found.y_m) == pytest.approx((2.0, 0.0), abs=0.06)


@pytest.mark.parametrize("side", [-1.0, 1.0])
@pytest.mark.parametrize(
    ("near_m", "far_m", "apart_rad"), [(1.81, 2.3, 0.155), (1.35, 1.8, 0.161), (0.62, 0.91, 0.716)]
)
def test_robot_close_behind_another_is_in_its_place(near_m: float, far_m: float, apart_rad: float, side: float) -> None:
    """The robots nearly touch each other, and one hides a part of the other."""
    for bearing_rad in np.linspace(1.0, 1.035, 4):
        places = [
            distance_m * np.array((math.cos(angle), math.sin(angle)))
            for distance_m, angle in ((near_m, bearing_rad), (far_m, bearing_rad + side * apart_rad))
        ]
        others = [(x_m - 3.0, y_m + 2.0, CYAN) for x_m, y_m in places]
        found = obstacles(renderer().render(Scene(Pose(-3.0, 2.0, 0.0), others, None)))
        errors_m = [min(math.dist(place, (each.x_m, each.y_m)) for each in found) for place in places]
        assert len(found) == 2
        assert max(errors_m) < 0.1


@pytest.mark.parametrize("away_m", [1.0, 2.0, 3.0, 4.0])
@pytest.mark.parametrize("ball_rad", [0.0, 0.5, -0.5])
@pytest.mark.parametrize("bearing_rad", [0.0, 2.0, math.pi])  # the rays begin and end at 0
def test_held_ball_leaves_a_robot_in_its_place(away_m: float, ball_rad: float, bearing_rad: float) -> None:
    """A robot holds a ball straight before it, or 0.5 rad aside, where the ball hides one side of its foot."""
    rng, errors_m = np.random.default_rng(4), []
    for turn_rad in np.linspace(0.0, 0.035, 8):  # the angle between two rays
        heading_rad = bearing_rad + turn_rad + math.pi + ball_rad
        place = away_m * np.array((math.cos(bearing_rad + turn_rad), math.sin(bearing_rad + turn_rad)))
        robot = place + np.array((-3.0, 2.0))
        ball = robot + 0.33 * np.array((math.cos(heading_rad), math.sin(heading_rad)))
        scene = Scene(Pose(-3.0, 2.0, 0.0), [(*robot, CYAN)], (*ball, 0.11))
        (found,) = obstacles(picture(scene, rng))
        errors_m.append((place[0] * found.y_m - place[1] * found.x_m) / away_m)
    assert abs(np.mean(errors_m)) < 0.03


@pytest.mark.parametrize("away_m", [2.0, 4.0, -2.0, -4.0])
@pytest.mark.parametrize("lateral_m", [-0.1, 0.0, 0.1])
def test_lone_robot_straight_ahead_or_behind_is_in_place(away_m: float, lateral_m: float) -> None:
    """The rays begin and end straight ahead."""
    (found,) = obstacles(renderer().render(Scene(Pose(-3.0, 2.0, 0.0), [(away_m - 3.0, 2.0 + lateral_m, CYAN)], None)))
    assert (found.x_m, found.y_m) == pytest.approx((away_m, lateral_m), abs=0.06)


def test_touching_robot_is_seen() -> None:
    (found,) = obstacles(renderer().render(Scene(Pose(-3.0, 2.0, 0.0), [(-2.5, 2.0, CYAN)], None)))
    assert (found.x_m, found.y_m) == pytest.approx((0.5, 0.0), abs=0.05)


@pytest.mark.parametrize("colour", [BLACK, WHITE, GREEN])
def test_picture_of_one_colour_shows_nothing(colour: Bgr) -> None:
    frame = np.full((400, 400, 3), colour, np.uint8)
    assert len(line_points(frame)) == 0
    assert obstacles(frame) == []


def test_pure_noise_shows_next_to_nothing() -> None:
    rng = np.random.default_rng(9)
    for _ in range(10):
        frame = rng.integers(0, 256, (400, 400, 3), dtype=np.uint8)
        assert len(line_points(frame)) < 40
        assert len(obstacles(frame)) <= 2
