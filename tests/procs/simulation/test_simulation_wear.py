"""Signs of use and faults of a camera: worn lines, specks, a cast, a tilt, bursts of lost frames."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import numpy as np
import pytest

from fwk import Component
from fwk.testing import Bench
from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.field import Field
from procs.model.realism import Realism
from procs.simulation import camera_errors, percept_errors
from procs.simulation.camera import Camera
from procs.simulation.gaps import Gaps
from procs.simulation.percepts import Percepts
from procs.simulation.rendering.carpet import Wear, lay_carpet
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.simulation.stereo_camera import StereoCamera
from procs.vision.colours import WHITE

FIELD = Field()


def white(wear: Wear) -> tuple[int, int]:
    """Returns the number of white pixels on the carpet, and on the floor around it."""
    carpet = lay_carpet(FIELD, wear=wear)
    found = (carpet.pixels == WHITE).all(axis=2)
    columns, rows = (round(half_m / carpet.metres_per_px) for half_m in (12.0, 8.0))
    middle_column, middle_row = (round(at) for at in carpet.origin_px)
    inside = found[middle_row - rows : middle_row + rows, middle_column - columns : middle_column + columns]
    return int(inside.sum()), int(found.sum() - inside.sum())


def test_worn_lines_lose_their_share_of_paint() -> None:
    new, floor = white(Wear())
    assert floor == 0
    assert white(Wear(worn=0.2))[0] == pytest.approx(0.8 * new, rel=0.03)


def test_specks_lie_on_the_floor_alone() -> None:
    new, _ = white(Wear())
    on_carpet, on_floor = white(Wear(clutter_1_m2=0.5))
    assert on_carpet == new
    assert 20 < on_floor / 26 < 80  # some 26 pixels each, on 129 square metres


def test_cast_changes_each_colour_by_its_factor() -> None:
    noise = SensorNoise((100, 100, 3), 0.0, 1.0, 0.0, cast=(1.2, 1.0, 0.8))
    seen = noise.apply(np.full((100, 100, 3), 100, np.uint8), np.random.default_rng(1))
    assert seen[50, 50].tolist() == [120, 100, 80]


def test_gaps_are_as_many_and_as_long_as_set() -> None:
    gaps, blind = Gaps(np.random.default_rng(1)), []
    for frame in range(60_000):
        blind.append(gaps.blind(80_000 * frame, gaps_1_min=6.0, gap_s=0.5))
    begun = sum(now and not before for before, now in zip([False, *blind], blind, strict=False))
    assert begun / 80.0 == pytest.approx(6.0, rel=0.15)
    assert np.mean(blind) == pytest.approx(0.05, rel=0.2)
    assert not any(map(partial(Gaps(np.random.default_rng(1)).blind, gaps_1_min=0.0, gap_s=1.0), range(1000)))


def frames_of(kind: type[Component], port: str, **settings: Any) -> list[Any]:
    bench = Bench(kind, name="cyan1/eye", realism="none", **settings)
    truth, robot = ground_truth_t(), true_robot_t()
    robot.name, robot.team, robot.number, robot.x_m = "cyan1", "cyan", 1, -3.0
    truth.robots = [robot]
    for _ in range(20):
        truth.header.time_us = bench.time_us
        bench.port("ground_truth").put(truth)
        bench.iterate()
    return list(bench.port(port).sent)


@pytest.mark.parametrize(
    ("kind", "port"), [(Camera, "image"), (StereoCamera, "stereo_image"), (Percepts, "line_points")]
)
def test_sensors_lose_frames_in_a_row(kind: type[Component], port: str) -> None:
    assert len(frames_of(kind, port)) == 20
    assert len(frames_of(kind, port, gaps_1_min=1e6, gap_s=60.0)) <= 1


def test_tilt_moves_what_percepts_show() -> None:
    straight, tilted = (frames_of(Percepts, "ball_percept", tilt_sd_deg=tilt)[-1] for tilt in (0.0, 1.0))
    assert straight.x_m == pytest.approx(3.0, abs=1e-6)
    assert 0.01 < np.hypot(tilted.x_m - 3.0, tilted.y_m) < 0.5


def test_tilt_and_cast_change_the_picture() -> None:
    bare = Bench(Camera, name="cyan1/camera", realism="none").component
    tilted = Bench(Camera, name="cyan1/camera", realism="none", tilt_sd_deg=1.0, cast=0.1).component
    assert isinstance(bare, Camera)
    assert isinstance(tilted, Camera)
    grey, rng = np.full((430, 430, 3), 100, np.uint8), np.random.default_rng(1)
    assert bare._renderer._mirror.roll_rad == 0.0
    assert np.array_equal(bare._noise.apply(grey, rng), grey)
    assert 0.0 < abs(tilted._renderer._mirror.roll_rad) < 0.1
    assert 5 < np.ptp(tilted._noise.apply(grey, rng)[0, 0].astype(int)) < 50


def test_vignette_darkens_the_edge_beside_a_cast() -> None:
    noise = SensorNoise((100, 100, 3), 0.0, 1.0, 0.0, vignette=0.2, cast=(1.1, 1.0, 0.9))
    seen = noise.apply(np.full((100, 100, 3), 100, np.uint8), np.random.default_rng(1))
    assert seen[50, 50].tolist() == [110, 100, 90]
    assert seen[0, 0].tolist() == [88, 80, 72]


@pytest.mark.parametrize("errors", [camera_errors.PRESETS, percept_errors.PRESETS])
def test_realistic_errors_come_in_bursts(errors: Mapping[Realism, Any]) -> None:
    harsh, realistic = errors["harsh"], errors["realistic"]
    assert 0 < realistic.gaps_1_min < harsh.gaps_1_min
    assert 0 < realistic.gap_s < harsh.gap_s


def test_phantoms_lie_in_the_own_mouth() -> None:
    far = {"ball_reach_m": 1.0}  # the real ball is out of reach
    assert not any(each.visible for each in frames_of(Percepts, "ball_percept", **far))
    seen = frames_of(Percepts, "ball_percept", mouth_phantoms_1_s=1e6, **far)[1:]
    assert {(round(each.x_m, 3), each.y_m) for each in seen} == {(round(0.25 * 0.75**0.5 + 0.11, 3), 0.0)}
