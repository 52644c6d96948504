"""The ground in the mirror: the same pixels as if each were looked up, and noise that cameras share."""

import math

import cv2
import numpy as np
import pytest

from procs.model.field import Field
from procs.simulation.rendering.carpet import FLOOR_NUMBER, colour_in, lay_carpet
from procs.simulation.rendering.ground_view import MARGIN_PX, GroundView
from procs.simulation.rendering.sensor_noise import SensorNoise
from procs.vision.colours import FLOOR, Picture
from procs.vision.mirror import Mirror

CARPET = lay_carpet(Field())


def looked_up(mirror: Mirror, x_m: float, y_m: float, heading_rad: float, right: int, down: int) -> Picture:
    """Returns the ground that each pixel of the whole picture sees."""
    at_px = np.arange(mirror.size_px, dtype=float)
    columns, rows = np.meshgrid(at_px - right / 2, at_px - down / 2)
    ahead_m, left_m = np.nan_to_num(mirror.ground(np.column_stack((columns.ravel(), rows.ravel()))), nan=1e6).T
    cosine, sine = math.cos(heading_rad), math.sin(heading_rad)
    on_carpet = ((x_m + cosine * ahead_m - sine * left_m), (y_m + sine * ahead_m + cosine * left_m))
    x_px, y_px = (
        (at_m / CARPET.metres_per_px + zero).reshape(mirror.size_px, -1).astype(np.float32)
        for at_m, zero in zip(on_carpet, CARPET.origin_px, strict=True)
    )
    numbers = cv2.remap(CARPET.numbers, x_px, y_px, cv2.INTER_NEAREST, borderValue=(FLOOR_NUMBER,))
    pixels = np.empty((*numbers.shape, 3), np.uint8)
    colour_in(pixels, np.asarray(numbers, np.uint8))
    return pixels


@pytest.mark.parametrize("mirror", [Mirror(), Mirror(roll_rad=0.08, pitch_rad=-0.05), Mirror(size_px=100)])
@pytest.mark.parametrize("shift", [(0, 0), (12, -12), (-11, 7)])
def test_bands_show_what_each_pixel_sees(mirror: Mirror, shift: tuple[int, int]) -> None:
    assert max(map(abs, shift)) <= 2 * MARGIN_PX
    view = GroundView(mirror, CARPET)
    for pose in ((0.0, 0.0, 0.3), (-10.0, 6.5, 2.0), (11.9, -7.9, -1.1)):
        wrong = (view.picture(*pose, *shift) != looked_up(mirror, *pose, *shift)).any(axis=2)
        assert wrong.mean() < 2e-3, "rounding may take another pixel of the carpet at an edge"


def test_sky_has_the_colour_of_the_surroundings() -> None:
    view = GroundView(Mirror(), CARPET)
    assert (view.picture(0.0, 0.0, 0.0)[:5] == FLOOR).all()


def test_cameras_share_the_noise_but_not_its_place() -> None:
    grey = np.full((200, 200, 3), 128, np.uint8)
    noises = [SensorNoise((200, 200, 3), 5.0, 1.0, 0.0) for _ in range(2)]
    first, second = (noise.apply(grey, np.random.default_rng(seed)) for seed, noise in enumerate(noises))
    assert np.shares_memory(noises[0]._lighter, noises[1]._lighter)
    assert abs(np.corrcoef(first.ravel(), second.ravel())[0, 1]) < 0.02
