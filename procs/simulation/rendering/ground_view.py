"""The ground as the mirror shows it: the carpet warped to a robot's view."""

import math
from functools import lru_cache

import cv2
import numpy as np
from numpy.typing import NDArray

from procs.simulation.rendering.carpet import FLOOR_NUMBER, Carpet, coloured
from procs.vision.colours import Picture
from procs.vision.mirror import Mirror

MARGIN_PX = 6  # how far the picture can shake
_FAR_M = 1e4  # where pixels above the horizon look: off the carpet, which gives the colour of the surroundings


class GroundView:
    """Looks up what each pixel sees on the carpet."""

    def __init__(self, mirror: Mirror, carpet: Carpet) -> None:
        self._size_px = mirror.size_px
        self._carpet = carpet
        self._maps = _ground_maps(mirror)

    def picture(self, x_m: float, y_m: float, heading_rad: float, right: int = 0, down: int = 0) -> Picture:
        """Returns the ground seen from a pose in the world; `right` and `down` shift the picture by half pixels."""
        carpet = self._carpet
        cosine, sine = (f(heading_rad) / carpet.metres_per_px for f in (math.cos, math.sin))
        column, row = (at / carpet.metres_per_px + zero for at, zero in zip((x_m, y_m), carpet.origin_px, strict=True))
        top, left = MARGIN_PX - down // 2, MARGIN_PX - right // 2
        ground = self._maps[down % 2][right % 2][top : top + self._size_px, left : left + self._size_px]
        looked_up = cv2.transform(ground, np.array([[cosine, -sine, column], [sine, cosine, row]]))
        # Nearest neighbours: bilinear interpolation differs between OpenCV's versions, and costs more.
        numbers = cv2.remap(  # type: ignore[call-overload]  # the stubs do not know that one map can hold both coordinates
            carpet.numbers, looked_up, None, cv2.INTER_NEAREST, borderValue=(FLOOR_NUMBER,)
        )
        return coloured(numbers)


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
