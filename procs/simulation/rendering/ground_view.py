"""The ground as the mirror shows it: the carpet warped to a robot's view."""

import math
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from procs.simulation.rendering.carpet import FLOOR_NUMBER, Carpet, colour_in
from procs.vision.colours import FLOOR, Picture
from procs.vision.mirror import Mirror

MARGIN_PX = 6  # how far the picture can shake
_FAR_M = 1e4  # where pixels above the horizon look: off the carpet, which gives the colour of the surroundings
_BAND_PX = 54  # height of a band; lower ones leave out more pixels above the horizon, but need more calls


def half_pixels(shake_px: tuple[float, float]) -> tuple[int, int]:
    """Returns the half pixels, columns and rows, by which a shake moves a picture: at most its margin."""
    right, down = (round(2 * min(max(shake, -MARGIN_PX), MARGIN_PX)) for shake in shake_px)
    return right, down


class GroundView:
    """Looks up what each pixel sees on the carpet, in bands that end where the ground does."""

    def __init__(self, mirror: Mirror, carpet: Carpet) -> None:
        self._carpet = carpet
        self._maps = _ground_maps(mirror)
        self._bands = _bands(self._maps, mirror.size_px)
        self._surroundings = _surroundings(mirror.size_px)

    def picture(self, x_m: float, y_m: float, heading_rad: float, right: int = 0, down: int = 0) -> Picture:
        """Returns the ground seen from a pose in the world; `right` and `down` shift the picture by half pixels."""
        carpet = self._carpet
        cosine, sine = (f(heading_rad) / carpet.metres_per_px for f in (math.cos, math.sin))
        column, row = (at / carpet.metres_per_px + zero for at, zero in zip((x_m, y_m), carpet.origin_px, strict=True))
        to_carpet = np.array([[cosine, -sine, column], [sine, cosine, row]])
        ground, past_px, below_px = self._maps[down % 2][right % 2], MARGIN_PX - right // 2, MARGIN_PX - down // 2
        seen = self._surroundings.copy()
        for top, bottom, left, end in self._bands:
            part = ground[below_px + top : below_px + bottom, past_px + left : past_px + end]
            # Nearest neighbours: bilinear interpolation differs between OpenCV's versions, and costs more.
            numbers = cv2.remap(  # type: ignore[call-overload]  # the stubs do not know that one map can hold both coordinates
                carpet.numbers, cv2.transform(part, to_carpet), None, cv2.INTER_NEAREST, borderValue=(FLOOR_NUMBER,)
            )
            colour_in(seen[top:bottom, left:end], numbers)
        return seen


@lru_cache(maxsize=4)
def _surroundings(size_px: int) -> Picture:
    """Returns a picture without ground; all cameras of one size share it."""
    return np.full((size_px, size_px, 3), FLOOR, np.uint8)


def _bands(maps: list[list[NDArray[np.float32]]], size_px: int) -> list[tuple[int, int, int, int]]:
    """Returns the bands that see ground, however the picture shakes: (top, bottom, left, right), ends excluded."""
    sees_ground = np.any([np.abs(each[..., 0]) < _FAR_M for row in maps for each in row], axis=0)
    bands = []
    for top in range(0, size_px, _BAND_PX):
        bottom = min(top + _BAND_PX, size_px)
        columns = np.flatnonzero(sees_ground[top : bottom + 2 * MARGIN_PX].any(axis=0))
        if len(columns):
            bands.append((top, bottom, max(int(columns[0]) - 2 * MARGIN_PX, 0), min(int(columns[-1]) + 1, size_px)))
    return bands


@lru_cache(maxsize=4)
def _ground_maps(mirror: Mirror) -> list[list[NDArray[np.float32]]]:
    """Returns the maps of pictures with and without a shift of half a pixel, made once in each process."""
    return [[_ground_map(mirror, right / 2, down / 2) for right in (0, 1)] for down in (0, 1)]


def _ground_map(mirror: Mirror, right_px: float, down_px: float) -> NDArray[np.float32]:
    """Returns robot frame coordinates of the ground for each pixel of the moved picture, and for a margin around it."""
    at_px = np.arange(-MARGIN_PX, mirror.size_px + MARGIN_PX)
    columns, rows = np.meshgrid(at_px - right_px, at_px - down_px)
    ground_m = mirror.ground(np.column_stack((columns.ravel(), rows.ravel())))
    ground_m = np.nan_to_num(ground_m, nan=_FAR_M).clip(-_FAR_M, _FAR_M)
    return ground_m.reshape(len(at_px), len(at_px), 2).astype(np.float32)
