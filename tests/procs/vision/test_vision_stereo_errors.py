"""Errors of a stereo pair by the presets: what each does to the pictures, and what the detector states."""

import math
from typing import Any

import numpy as np
import pytest

from fwk import Clock, Component, Writes
from fwk.testing import MemorySystem
from lcmtypes.soccer import ground_truth_t
from procs.model.expected_errors import EXPECTED
from procs.model.realism import Realism
from procs.simulation.stereo_camera import StereoCamera
from procs.vision.stereo_obs import StereoObs
from procs.vision.stereo_rig import Grey, StereoRig
from tests.procs.vision.picture_parts import robot

RIG = StereoRig()


class Before(Component):
    """A robot drives over the field; another one stands before it, each tick at another place."""

    stage = "pre_loop"
    ground_truth: Writes[ground_truth_t]
    clock: Clock

    def loop(self) -> None:
        x_m, y_m, ahead_m, left_m, heading_rad = np.random.default_rng(self.clock.tick).uniform(
            (-8.0, -5.0, 1.2, -0.3, -math.pi), (4.0, 5.0, 4.2, 0.3, math.pi)
        )
        along = np.array((math.cos(heading_rad), math.sin(heading_rad)))
        there_x_m, there_y_m = (x_m, y_m) + ahead_m * (along + left_m * np.array((-along[1], along[0])))
        own = robot("cyan1", x_m, y_m, heading_rad)
        own.vx_m_s, own.vy_m_s = along.tolist()
        self.ground_truth.value.robots = [own, robot("magenta1", there_x_m, there_y_m, 0.0)]
        self.ground_truth.write()


def pair(realism: Realism = "none", seed: int = 1, **camera: Any) -> MemorySystem:
    parts = {"world/world": Before, "cyan1/stereo_camera": StereoCamera, "cyan1/stereo_obs": StereoObs}
    exact = {"realism": realism, "latency_s": 0.0, "gaps_1_min": 0.0, **camera}
    return MemorySystem(parts, {"cyan1/stereo_camera": exact, "cyan1/stereo_obs": {"realism": realism}}, seed=seed)


def halves(ticks: int = 1, **camera: Any) -> tuple[Grey, Grey]:
    """Returns the frames of both cameras in a tick."""
    run = pair(**camera)
    run.tick(ticks)
    detector: Any = run.runners["cyan1/stereo_obs"].component
    return RIG.halves(detector.stereo_image.pixels)


def sharpness(frame: Grey) -> float:
    return float(np.abs(np.diff(frame.astype(float), axis=1)).mean())


@pytest.mark.parametrize("error", ["shake_px", "tilt_sd_deg"])
def test_pair_moves_as_a_whole(error: str) -> None:
    """Both frames are moved alike, so disparities stay as they are."""
    large: dict[str, Any] = {error: 1.5}
    still, moved = halves(), halves(**large)
    assert all((one != other).mean() > 0.05 for one, other in zip(still, moved, strict=True))
    run, shaken = pair(), pair(**large)
    for each in (run, shaken):
        each.tick(3)
    (found,), (again,) = (each.newest("cyan1/stereo_obstacles").obstacles for each in (run, shaken))
    assert (again.x_m, again.y_m) == pytest.approx((found.x_m, found.y_m), abs=0.1)


def test_blur_and_vignette_are_those_of_each_frame() -> None:
    sharp, blurred, shaded = halves(), halves(blur_px=2.0), halves(vignette=0.5)
    for camera in (0, 1):
        assert sharpness(blurred[camera]) < 0.8 * sharpness(sharp[camera])
        shades = shaded[camera] / sharp[camera]
        assert shades[100, 200] == pytest.approx(1.0, abs=0.02)
        assert shades[100, 0] == pytest.approx(0.5, abs=0.02)


def test_cameras_of_a_pair_differ_in_brightness() -> None:
    plain = np.array([frame.mean() for frame in halves()])
    cast = np.array([frame.mean() for frame in halves(cast=0.1)]) / plain
    assert 0.01 < np.ptp(cast) < 0.4
    flickering = np.array([[frame.mean() for frame in halves(ticks, flicker=0.1)] for ticks in (1, 2, 3)])
    steady = np.array([[frame.mean() for frame in halves(ticks)] for ticks in (1, 2, 3)])
    assert np.ptp(flickering / steady, axis=0).min() > 0.02


@pytest.mark.parametrize("wear", [{"worn": 1.0}, {"clutter_1_m2": 10.0}])
def test_pair_sees_signs_of_use(wear: dict[str, Any]) -> None:
    assert any((halves(ticks)[0] != halves(ticks, **wear)[0]).any() for ticks in range(1, 6))


@pytest.mark.slow
@pytest.mark.parametrize("realism", ["none", "friendly", "realistic", "harsh"])
def test_stated_errors_are_those_of_the_preset(realism: Realism) -> None:
    """Robots that hide each other err by more than those of this test, which stand alone."""
    surprises: list[float] = []
    along_px: list[float] = []
    for seed in range(1, 9):
        run = pair(realism, seed)
        for _ in range(15):
            run.tick()
            own, other = run.newest("world/ground_truth").robots
            cosine, sine = math.cos(own.heading_rad), math.sin(own.heading_rad)
            away_m = np.array(((cosine, sine), (-sine, cosine))) @ (other.x_m - own.x_m, other.y_m - own.y_m)
            found = run.newest("cyan1/stereo_obstacles").obstacles
            errors_m = [np.array((each.x_m, each.y_m)) - away_m for each in found]
            number = min(range(len(found)), key=lambda each: float(np.hypot(*errors_m[each])))
            error_m, covariance_m2 = errors_m[number], found[number].covariance_m2
            surprises.append(float(error_m @ np.linalg.solve(covariance_m2, error_m)))
            range_m = math.hypot(away_m[0] - RIG.forward_m, away_m[1])
            along_px.append(error_m[0] * RIG.focal_px * RIG.baseline_m / range_m**2)
    assert np.mean(np.array(surprises) < 5.99) > 0.95
    assert np.sqrt(np.mean(np.square(along_px))) < EXPECTED[realism].stereo_px
