"""Obstacles from a stereo pair: places, honesty, what is not an obstacle, and fusion with the other camera."""

import math

import cv2
import numpy as np
import pytest

from fwk.testing import Bench, system_of
from lcmtypes.soccer import obstacle_percepts_t, obstacle_t
from procs.model.algebra import Floats
from procs.model.field import Field
from procs.simulation.rendering.renderer import Pose
from procs.simulation.rendering.shapes import Bodies
from procs.simulation.rendering.stereo_renderer import StereoRenderer
from procs.vision.obstacle_finder import Obstacle
from procs.vision.obstacle_fusion import ObstacleFusion, joined
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


def obstacle(x_m: float, y_m: float, along_m: float = 0.1, across_m: float = 0.1) -> obstacle_t:
    made = obstacle_t()
    made.x_m, made.y_m, made.radius_m = x_m, y_m, 0.25
    made.covariance_m2 = [[along_m**2, 0.0], [0.0, across_m**2]]
    return made


@pytest.mark.parametrize("ahead_m", [1.2, 2.0, 3.0, 4.0])
def test_robot_ahead_is_found_at_its_place(ahead_m: float) -> None:
    errors = []
    for seed in range(8):
        left_m = 0.25 * ahead_m * math.sin(seed)
        (found,) = seen((ahead_m, left_m), seed=seed)
        errors.append((found.x_m - ahead_m, found.y_m - left_m))
        assert found.covariance_m2[0, 0] < 0.3**2
    assert np.sqrt(np.mean(np.square(errors), axis=0)) == pytest.approx((0.0, 0.0), abs=0.03 + 0.015 * ahead_m**2)


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


def test_picture_of_another_size_is_scaled() -> None:
    frame = RENDERER.render(
        OWN, [(OWN.x_m + 2.0 * math.cos(OWN.heading_rad), OWN.y_m + 2.0 * math.sin(OWN.heading_rad))]
    )
    bench = Bench(StereoObs)
    bench.show("stereo_image", cv2.cvtColor(cv2.resize(frame, (1600, 400)), cv2.COLOR_GRAY2BGR))
    bench.iterate()
    (found,) = bench.port("stereo_obstacles").sent[-1].obstacles
    assert (found.x_m, found.y_m) == pytest.approx((2.0, 0.0), abs=0.15)


def test_fusion_weights_by_covariance_and_keeps_the_rest() -> None:
    around = [obstacle(2.0, 0.0, along_m=0.2, across_m=0.05), obstacle(-1.0, 1.0)]
    ahead = [obstacle(2.2, 0.1, along_m=0.05, across_m=0.2), obstacle(3.0, 1.0)]
    first, behind, new = joined(around, ahead, same_m=0.4)
    assert (first.x_m, first.y_m) == pytest.approx((2.0 + 0.2 * 16 / 17, 0.1 / 17))
    assert first.covariance_m2[0][0] < 0.05**2
    assert (behind.x_m, new.x_m) == (-1.0, 3.0)


def test_fusion_takes_percepts_of_one_time_only() -> None:
    bench = Bench(ObstacleFusion)
    for capture_us, count in ((100_000, 1), (10_000, 2)):
        for port, x_m, time_us in (("stereo_obstacles", 2.1, capture_us), ("obstacle_percepts", 1.0, 110_000)):
            percepts = obstacle_percepts_t()
            percepts.capture_us, percepts.obstacles = time_us, [obstacle(x_m if count == 1 else 1.0, 0.0)]
            bench.port(port).put(percepts)
        bench.iterate()
    first, second = bench.port("fused_obstacles").sent
    assert ([each.x_m for each in first.obstacles], first.capture_us) == ([1.0, 2.1], 110_000)
    assert [each.x_m for each in second.obstacles] == [1.0]


def test_impossible_covariance_does_not_spoil_the_other() -> None:
    broken = obstacle(2.0, 0.0)
    broken.covariance_m2 = [[math.nan, 0.0], [0.0, 1.0]]
    (kept,) = joined([broken], [obstacle(2.1, 0.0)], same_m=0.4)
    assert kept.x_m == 2.1


def test_lone_robot_of_the_launch_file_sees_with_both() -> None:
    system = system_of("one-robot.yaml", lambda name: name.startswith(("world", "cyan1", "team_cyan")))
    system.tick(10)
    fused = [obstacle_percepts_t.decode(sent) for sent in system.sent["cyan1/fused_obstacles"]]
    stereo = [obstacle_percepts_t.decode(sent) for sent in system.sent["cyan1/stereo_obstacles"]]
    assert len(fused) == len(stereo) == 5
    assert all(one.capture_us == other.capture_us for one, other in zip(fused, stereo, strict=True))


def test_disparity_tells_the_distance() -> None:
    frame = RENDERER.render(
        OWN, [(OWN.x_m + 2.0 * math.cos(OWN.heading_rad), OWN.y_m + 2.0 * math.sin(OWN.heading_rad))]
    )
    found: Floats = FINDER.disparity(frame)
    middle = found[85:115, 190:210]
    expected_px = RIG.focal_px * RIG.baseline_m / (2.0 - RIG.forward_m - 0.25)
    assert float(np.nanmedian(middle)) == pytest.approx(expected_px, abs=0.7)
