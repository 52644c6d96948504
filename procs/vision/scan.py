"""Scan lines: the pixels of a picture along rays from the robot and along rings around it."""

import math
from functools import lru_cache

import cv2
import numpy as np

from procs.model.algebra import Floats, Indices
from procs.vision.colours import Mask, Picture
from procs.vision.mirror import Mirror


class Scan:
    """Scan lines of the same length; equal scans are made once in each process.

    `ground_m` (lines, samples, 2) is the place on the ground, robot frame, that the middle of each pixel shows; NaN
    above the horizon. It differs from the ideal place on the scan line, because samples are whole pixels.
    """

    def __init__(self, mirror: Mirror, columns: Floats, rows: Floats) -> None:
        """Takes the columns and rows (lines, samples) of the scan lines, in pixels; they are rounded."""
        last_px = mirror.size_px - 1
        self._map = np.rint(np.stack((columns, rows), axis=2)).clip(0, last_px).astype(np.int16)
        pixels = self._map.reshape(-1, 2).astype(float)
        self.ground_m = mirror.ground(pixels).reshape(*columns.shape, 2)

    @classmethod
    @lru_cache(maxsize=4)
    def star(cls, mirror: Mirror, rays: int, from_m: float, to_m: float) -> "Scan":
        """Returns rays at equal angles, counter-clockwise from straight ahead, with one sample per pixel, outwards.

        They end where the mirror's picture does.
        """
        angles = np.linspace(0.0, 2 * math.pi, rays, endpoint=False)
        radii_px = np.arange(mirror.radius_px(from_m), min(mirror.radius_px(to_m), _last_px(mirror)))
        return cls(mirror, *_around(mirror, angles[:, None], radii_px[None]))

    @classmethod
    @lru_cache(maxsize=4)
    def rings(cls, mirror: Mirror, distances_m: tuple[float, ...]) -> "Scan":
        """Returns circles on the ground, counter-clockwise from straight behind; the largest has a sample per pixel.

        Those that the mirror's picture does not show are left out.
        """
        every_px = np.array([mirror.radius_px(distance_m) for distance_m in distances_m])
        radii_px = every_px[every_px < _last_px(mirror)]
        samples = math.ceil(2 * math.pi * radii_px.max(initial=0.0))
        angles = np.linspace(math.pi, 3 * math.pi, samples, endpoint=False)
        return cls(mirror, *_around(mirror, angles[None], radii_px[:, None]))

    def look_up(self, pixels: Picture) -> Picture:
        """Returns the picture along the scan lines: (lines, samples, 3)."""
        if not self._map.size:
            return np.empty((*self._map.shape[:2], 3), np.uint8)
        seen = cv2.remap(  # type: ignore[call-overload]  # the stubs do not know that one map can hold both coordinates
            pixels, self._map, None, cv2.INTER_NEAREST
        )
        return np.asarray(seen, np.uint8)


def _around(mirror: Mirror, angles: Floats, radii_px: Floats) -> tuple[Floats, Floats]:
    return mirror.centre_px - radii_px * np.sin(angles), mirror.centre_px - radii_px * np.cos(angles)


def _last_px(mirror: Mirror) -> float:
    """Returns the radius of the last pixels that lie wholly in the mirror's round picture."""
    return mirror.size_px / 2 - 1


def runs(mask: Mask) -> tuple[Indices, Indices, Indices]:
    """Returns line, first sample and sample after the end of each unbroken run of true values in a mask.

    The mask is (lines, samples); each result is (runs).
    """
    lines, samples = mask.shape
    padded = np.zeros((lines, samples + 1), dtype=bool)  # a false value after each line ends its runs
    padded[:, :samples] = mask
    flat = padded.reshape(-1)
    changes = np.flatnonzero(np.concatenate((flat[:1], flat[1:] != flat[:-1])))
    line, start = np.divmod(changes[::2], samples + 1)
    return line, start, changes[1::2] - line * (samples + 1)
