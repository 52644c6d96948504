"""Obstacles from a stereo pair: places, honesty, what is not an obstacle, and settings."""

import math
from typing import Any

import cv2
import numpy as np
import pytest

from fwk import Component, VisionMaster
from fwk.model.errors import PlanError
from fwk.testing import Bench, MemorySystem, launch_plan
from procs.model.algebra import Floats
from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.model.robot import RobotModel
from procs.simulation.rendering.renderer import Pose
from procs.simulation.rendering.shapes import Bodies
from procs.simulation.rendering.stereo_renderer import StereoRenderer
from procs.vision.obstacle_finder import Obstacle
from procs.vision.stereo_finder import StereoFinder
from procs.vision.stereo_obs import StereoObs
from procs.vision.stereo_rig import StereoRig

RIG = StereoRig()
OWN = Pose(-4.0, 1.0, 0.4)
RENDERER = StereoRenderer(RIG, Field(), Bodies())
FINDER = StereoFinder(RIG)


def seen(*places_m: tuple[float, float], seed: int = 1, noise_levels: float = 5.0) -> list[Obstacle]:
    """Obstacles found in a noisy pair with robots at these places of the robot frame."""
    cosine, sine = math.cos(OWN.heading_rad), math.sin(OWN.heading_rad)
    robots = [(OWN.x_m + cosine * x - sine * y, OWN.y_m + sine * x + cosine * y) for x, y in places_m]
    frame = RENDERER.render(OWN, robots)
    noise = noise_levels * np.random.default_rng(seed).standard_normal(frame.shape)
    return FINDER.find(np.clip(frame + noise, 0, 255).astype(np.uint8))


@pytest.mark.parametrize("ahead_m", [1.2, 2.0, 3.0, 4.0])
def test_robot_ahead_is_found_at_its_place(ahead_m: float) -> None:
    errors = []
    for seed in range(8):
        left_m = 0.25 * ahead_m * math.sin(seed)
        (found,) = seen((ahead_m, left_m), seed=seed)
        errors.append((found.x_m - ahead_m, found.y_m - left_m))
        assert found.covariance_m2[0, 0] < 0.3**2
    assert np.sqrt(np.mean(np.square(errors), axis=0)) == pytest.approx((0.0, 0.0), abs=0.03 + 0.015 * ahead_m**2)


def test_pair_that_sees_no_ground_shows_robots() -> None:
    rig = StereoRig(width_px=800, height_px=80, focal_px=2400.0, baseline_m=0.05)
    renderer, away_m = StereoRenderer(rig, Field(), Bodies()), 4.0
    empty = renderer.render(Pose(0.0, 0.0, 0.0), [])
    assert (empty == empty[0, 0]).all()
    assert (renderer.render(Pose(0.0, 0.0, 0.0), [(away_m, 0.0)]) != empty).any()


@pytest.mark.slow
def test_stated_covariances_are_those_of_the_errors() -> None:
    surprises = []
    for seed in range(40):
        place_m = (1.0 + 0.07 * seed, 0.2 * math.sin(seed))
        for found in seen(place_m, seed=seed):
            error_m = np.array((found.x_m - place_m[0], found.y_m - place_m[1]))
            surprises.append(float(error_m @ np.linalg.solve(found.covariance_m2, error_m)))
    assert len(surprises) >= 38
    assert np.mean(np.array(surprises) < 5.99) > 0.85


def test_two_robots_are_two_obstacles() -> None:
    found = seen((2.0, 0.5), (2.6, -0.6))
    assert [(each.x_m, each.y_m) for each in found] == [
        pytest.approx((2.0, 0.5), abs=0.15),
        pytest.approx((2.6, -0.6), abs=0.15),
    ]


def test_lines_and_carpet_are_not_obstacles() -> None:
    for seed in range(5):
        assert seen(seed=seed) == []


def test_robot_beside_or_behind_is_not_seen() -> None:
    assert seen((-2.0, 0.0), (0.3, 2.0)) == []


@pytest.mark.parametrize("ahead_m", [2.0, 3.0])
@pytest.mark.parametrize("count", [2, 3])
def test_robots_that_touch_each_other_are_as_many_as_they_are(ahead_m: float, count: int) -> None:
    places = [(ahead_m, 0.52 * (number - (count - 1) / 2)) for number in reversed(range(count))]
    found = [(each.x_m, each.y_m) for each in seen(*places)]
    assert np.array(found) == pytest.approx(np.array(places), abs=0.1)


@pytest.mark.parametrize("left_m", [-0.55, -0.5, 0.4, 0.45])
def test_robot_at_the_pictures_edge_is_not_drawn_inward(left_m: float) -> None:
    """A part of it is outside; its middle follows from the edge that is seen."""
    for ahead_m in (1.6, 2.0, 2.7, 3.5):
        (found,) = seen((ahead_m, left_m * ahead_m))
        error = np.array((found.x_m - ahead_m, found.y_m - left_m * ahead_m))
        assert error @ np.linalg.solve(found.covariance_m2, error) < 9.2
        assert abs(error[1]) < 0.06


def test_robot_behind_another_is_not_drawn_to_its_visible_side() -> None:
    _, behind = seen((1.8, 0.1), (2.6, -0.25))
    assert behind.y_m == pytest.approx(-0.25, abs=0.06)


def test_noise_hardly_ever_makes_two_robots_of_one() -> None:
    surprises, twice = [], 0
    for seed in range(40):
        place_m = (1.1 + 0.05 * seed, 0.2 * math.sin(seed))
        found = seen(place_m, seed=seed, noise_levels=10.0)  # as in `harsh`
        twice += len(found) > 1
        for each in found:
            error_m = np.array((each.x_m - place_m[0], each.y_m - place_m[1]))
            surprises.append(float(error_m @ np.linalg.solve(each.covariance_m2, error_m)))
    assert twice <= 1
    assert len(surprises) >= 34
    assert np.mean(np.array(surprises) < 5.99) > 0.9


@pytest.mark.parametrize(
    "rig", [StereoRig(width_px=160, height_px=80, focal_px=120.0), StereoRig(baseline_m=0.3), StereoRig(height_m=0.8)]
)
def test_pairs_of_other_sizes_find_robots_from_near_on(rig: StereoRig) -> None:
    other = StereoRenderer(rig, Field(), Bodies())
    for ahead_m in (1.3, 2.0, 3.0):
        frame = other.render(Pose(0.0, 0.0, 0.0), [(ahead_m, 0.1)])
        (found,) = StereoFinder(rig).find(frame)
        assert (found.x_m, found.y_m) == pytest.approx((ahead_m, 0.1), abs=0.03 + 0.02 * ahead_m**2)


@pytest.mark.parametrize(
    ("width_px", "height_px", "focal_px", "nearest_m"),
    [(800, 400, 600.0, 1.2), (1600, 800, 1200.0, 1.2), (1000, 333, 790.0, 1.2), (400, 200, 1200.0, 2.0)],
)
def test_fine_pictures_and_long_lenses_show_robots(
    width_px: int, height_px: int, focal_px: float, nearest_m: float
) -> None:
    rig = StereoRig(width_px=width_px, height_px=height_px, focal_px=focal_px)
    renderer, bench, rng = StereoRenderer(rig, Field(), Bodies()), Bench(StereoObs, rig=rig), np.random.default_rng(1)
    for ahead_m in np.linspace(nearest_m, 4.0, 6).tolist():
        left_m = float(rng.uniform(-0.1, 0.1)) * ahead_m * width_px / focal_px
        frame = renderer.render(Pose(0.0, 0.0, 0.0), [(ahead_m, left_m)])
        bench.show("stereo_image", np.clip(frame + 5.0 * rng.standard_normal(frame.shape), 0, 255).astype(np.uint8))
        bench.iterate()
        (found,) = bench.port("stereo_obstacles").sent[-1].obstacles
        assert (found.x_m, found.y_m) == pytest.approx((ahead_m, left_m), abs=0.03 + 0.015 * ahead_m**2)


def test_reduced_rig_looks_the_same_way() -> None:
    rig = StereoRig(width_px=1000, height_px=334, focal_px=800.0)
    small = rig.reduced(400.0)
    assert (small.width_px, small.height_px, small.focal_px) == (500, 167, 400.0)
    assert RIG.reduced(400.0) is RIG
    strip = StereoRig(width_px=1600, height_px=80, focal_px=1200.0)
    assert strip.reduced(400.0) is strip
    narrow = StereoRig(width_px=401, height_px=300, focal_px=2000.0).reduced(400.0)
    assert narrow.width_px == 160
    assert narrow.focal_px == pytest.approx(2000.0 * 160 / 401)


def test_heights_looked_at_fit_low_robots_and_large_balls() -> None:
    low = RobotModel(height_m=0.32)
    frame = StereoRenderer(RIG, Field(), Bodies.of(low, BALL)).render(Pose(0.0, 0.0, 0.0), [(2.5, 0.0)])
    bench = Bench(StereoObs, robot=low.model_dump())
    bench.show("stereo_image", frame)
    bench.iterate()
    assert len(bench.port("stereo_obstacles").sent[-1].obstacles) == 1
    assert Bench(StereoObs, ball={"radius_m": 0.2}).component._finder.lowest_m > 0.4
    high, large = RobotModel(height_m=0.8), BallModel(radius_m=0.29)
    bench = Bench(StereoObs, robot=high.model_dump(), ball=large.model_dump())
    frame = StereoRenderer(StereoRig(), Field(), Bodies.of(high, large)).render(Pose(0.0, 0.0, 0.0), [(2.0, 0.0)])
    assert len(bench.component._finder.find(frame)) == 1


@pytest.mark.parametrize(
    ("setting", "mistake"),
    [
        ("focal_px=1e9", "focal_px of 1e+09 should be from 100 to 2000 for frames of 400 px"),
        ("focal_px=10", "focal_px of 10 should be from 100 to 2000"),
        ("width_px=64", "'rig.width_px' is 64; it should be greater than or equal to 160"),
        ("baseline_m=16", "'rig.baseline_m' is 16; it should be less than or equal to 0.6"),
        ("forward_m=100", "'rig.forward_m' is 100; it should be less than or equal to 0.5"),
        ("height_m=50", "'rig.height_m' is 50; it should be less than or equal to 2"),
    ],
)
def test_pair_that_cannot_be_is_refused(setting: str, mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("one-robot.yaml", (f"shared.rig.{setting}",))
    assert mistake in str(raised.value)


@pytest.mark.parametrize(
    ("settings", "mistake"),
    [
        (
            "*/stereo_obs.farthest_m=0.6",
            "'farthest_m' is 0.6; the pair measures from 0.762 m on; farthest_m should be greater",
        ),
        (
            "shared.rig.focal_px=900 shared.rig.baseline_m=0.6 */stereo_obs.farthest_m=3",
            "'farthest_m' is 3; the pair measures from 3.042 m on; farthest_m should be greater",
        ),
        (
            "shared.robot.height_m=0.25",
            "heights from 0.25 m on count; robots of 0.25 m should be higher, or the ball smaller",
        ),
        (
            "shared.ball.radius_m=0.29",
            "above a ball of 0.58 m, heights from 0.61 m on count; robots of 0.6 m should be higher",
        ),
        (
            "shared.rig.height_m=2",
            "the default of 'farthest_m' does not fit: the pair, 2 m high, shows robots from 4.984 m on; "
            "farthest_m should be greater, or the height nearer to that of robots",
        ),
        (
            "shared.rig.height_m=1.8 */stereo_obs.farthest_m=4.3",
            "'farthest_m' is 4.3; the pair, 1.8 m high, shows robots from 4.381 m on",
        ),
        (
            "shared.rig.height_m=0.8 shared.rig.focal_px=1900",
            "the pair, 0.8 m high, shows robots from 7.315 m on",
        ),
    ],
)
def test_settings_with_which_no_robot_is_seen_are_refused(settings: str, mistake: str) -> None:
    with pytest.raises(PlanError) as raised:
        launch_plan("one-robot.yaml", tuple(settings.split()))
    assert mistake in str(raised.value)


@pytest.mark.parametrize(
    ("settings", "ahead_m"),
    [
        ({"farthest_m": 0.8}, 1.1),
        ({"rig": {"focal_px": 2000.0}}, 4.0),
        ({"rig": {"focal_px": 900.0, "baseline_m": 0.6}}, 4.0),
        ({"rig": {"height_m": 1.8}}, 4.4),
        ({"robot": {"height_m": 0.28}}, 2.4),
        ({"ball": {"radius_m": 0.29}, "robot": {"height_m": 0.65}}, 2.4),
    ],
)
def test_unusual_settings_show_robots(settings: dict[str, Any], ahead_m: float) -> None:
    bench = Bench(StereoObs, **settings)
    config = bench.component.config
    renderer = StereoRenderer(config.rig, Field(), Bodies.of(config.robot, config.ball))
    bench.show("stereo_image", renderer.render(Pose(0.0, 0.0, 0.0), [(ahead_m, 0.0)]))
    bench.iterate()
    (found,) = bench.port("stereo_obstacles").sent[-1].obstacles
    assert (found.x_m, found.y_m) == pytest.approx((ahead_m, 0.0), abs=0.15)


def test_picture_of_another_size_is_scaled() -> None:
    frame = RENDERER.render(
        OWN, [(OWN.x_m + 2.0 * math.cos(OWN.heading_rad), OWN.y_m + 2.0 * math.sin(OWN.heading_rad))]
    )
    bench = Bench(StereoObs)
    bench.show("stereo_image", cv2.cvtColor(cv2.resize(frame, (1600, 400)), cv2.COLOR_GRAY2BGR))
    bench.iterate()
    (found,) = bench.port("stereo_obstacles").sent[-1].obstacles
    assert (found.x_m, found.y_m) == pytest.approx((2.0, 0.0), abs=0.15)


@pytest.mark.parametrize(("height_m", "count"), [(0.23, 0), (0.8, 1)])
@pytest.mark.parametrize("rig", [{}, {"height_px": 300}, {"width_px": 640, "height_px": 480, "focal_px": 480}])
def test_pair_of_another_shape_tells_heights(rig: dict[str, Any], height_m: float, count: int) -> None:
    """A 4:3 camera shows more above and below; what is lower than a ball still is no obstacle."""
    renderer = StereoRenderer(StereoRig(**rig), Field(), Bodies(robot_height_m=height_m))
    robot_m = OWN.x_m + 2.0 * math.cos(OWN.heading_rad), OWN.y_m + 2.0 * math.sin(OWN.heading_rad)
    bench = Bench(StereoObs)
    bench.show("stereo_image", renderer.render(OWN, [robot_m]))
    bench.iterate()
    assert len(bench.port("stereo_obstacles").sent[-1].obstacles) == count


class PlainPair(Component):
    """Does not know when its frames were exposed."""

    stage = "sensor_acquire"
    stereo_image: VisionMaster

    def loop(self) -> None:
        self.stereo_image.publish(np.zeros((200, 800), np.uint8))


def test_latency_of_a_camera_that_states_no_exposure_counts() -> None:
    parts = {"cyan1/pair": PlainPair, "cyan1/stereo_obs": StereoObs}
    run = MemorySystem(parts, settings={"cyan1/stereo_obs": {"latency_s": 0.08}})
    run.tick(5)
    assert run.newest("cyan1/stereo_obstacles").capture_us == run.newest("cyan1/stereo_image").header.time_us - 80_000


def test_frame_without_usable_colours_is_refused() -> None:
    bench = Bench(StereoObs)
    bench.show("stereo_image", np.zeros((100, 200, 2), np.uint8))
    with pytest.raises(ValueError, match="the frame is 100 x 200 x 2; the pair needs grey or three colours"):
        bench.iterate()


def test_grey_frame_may_have_a_channel_of_its_own() -> None:
    grey = np.random.default_rng(1).integers(0, 255, (60, 160), np.uint8)
    rig = StereoRig()
    for one, other in zip(rig.halves(grey[:, :, None]), rig.halves(grey), strict=True):
        assert np.array_equal(one, other)


def test_disparity_tells_the_distance() -> None:
    frame = RENDERER.render(
        OWN, [(OWN.x_m + 2.0 * math.cos(OWN.heading_rad), OWN.y_m + 2.0 * math.sin(OWN.heading_rad))]
    )
    found: Floats = FINDER.disparity(frame)
    middle = found[85:115, 190:210]
    expected_px = RIG.focal_px * RIG.baseline_m / (2.0 - RIG.forward_m - 0.25)
    assert float(np.nanmedian(middle)) == pytest.approx(expected_px, abs=0.7)
