"""The field seen from straight above: a texture of the carpet, its lines and marks, and the floor around it."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from procs.model.field import Arc, Field, Point, Segment
from procs.vision.colours import FLOOR, GREEN, WHITE, Bgr, Picture

METRES_PER_PX = 0.125 / 6  # an even part of the line width, so that most lines are painted exactly
_FLOOR_M = 1.5  # of floor painted beyond the border; farther away everything has the floor's mean colour
_PATCHES: tuple[Bgr, ...] = ((124, 120, 112), (96, 88, 84), (88, 104, 136), (142, 136, 130), (118, 98, 88))
_COLOURS = (FLOOR, GREEN, WHITE, *_PATCHES)
_PALETTE = np.zeros((256, 1, 3), np.uint8)
_PALETTE[: len(_COLOURS), 0] = _COLOURS
FLOOR_NUMBER = _COLOURS.index(FLOOR)
"""Number of the colour of everything beyond the carpet."""
_SHIFT = 4  # fractional bits of OpenCV's drawing coordinates
_ARC_STEP_RAD = math.radians(3.0)
_WEAR_SEED = 1


@dataclass(frozen=True)
class Carpet:
    """A picture of the ground: column grows with x, row with y; the world's origin lies at `origin_px`.

    A pixel is a byte, the number of its colour. A robot's view is looked up at scattered places, and a small table
    stays in the processor's cache.
    """

    numbers: NDArray[np.uint8]
    """Height x width."""
    origin_px: tuple[float, float]
    metres_per_px: float

    @property
    def pixels(self) -> Picture:
        """The picture in colours."""
        pixels = np.empty((*self.numbers.shape, 3), np.uint8)
        colour_in(pixels, self.numbers)
        return pixels


def colour_in(pixels: Picture, numbers: NDArray[np.uint8]) -> None:
    """Gives the pixels (height, width, 3) the colours of a picture of their numbers (height, width)."""
    cv2.applyColorMap(numbers, _PALETTE, pixels)


class Wear(NamedTuple):
    """Signs of use."""

    worn: float = 0.0
    """Part of the lines' paint that is missing, 0..1."""
    clutter_1_m2: float = 0.0
    """White specks on a square metre of the floor around the field."""
    bare_m: float = 0.0625
    """Width of a place where paint is missing."""
    speck_m: float = 0.06
    """Radius of a speck."""


NEW = Wear()
"""A new carpet on a tidy floor."""


@lru_cache(maxsize=4)
def lay_carpet(field: Field, metres_per_px: float = METRES_PER_PX, wear: Wear = NEW) -> Carpet:
    """Paints the field, its border and some of the floor around it; the same signs of use in every process."""
    half_m = (field.half_length_m + field.border_m + _FLOOR_M, field.half_width_m + field.border_m + _FLOOR_M)
    width, height = (2 * round(half / metres_per_px) for half in half_m)
    numbers = np.empty((height, width), np.uint8)
    _lay_floor(numbers, round(0.5 / metres_per_px))
    carpet = Carpet(numbers, ((width - 1) / 2, (height - 1) / 2), metres_per_px)
    x_m, y_m = field.half_length_m + field.border_m, field.half_width_m + field.border_m
    _paint(carpet, [Point(-x_m, -y_m), Point(x_m, -y_m), Point(x_m, y_m), Point(-x_m, y_m)], GREEN)
    line_m = field.line_width_m - metres_per_px  # OpenCV paints what an outline touches: half a pixel more on each side
    for segment in field.segments():
        _paint(carpet, _stripe(segment, line_m), WHITE)
    for arc in field.arcs():
        _paint(carpet, _band(arc, line_m), WHITE)
    for mark in field.marks():
        _paint(carpet, _circle(mark, (field.mark_diameter_m - metres_per_px) / 2), WHITE)
    rng = np.random.default_rng(_WEAR_SEED)
    _rub_off(carpet, wear, rng)
    _litter(carpet, field, wear, rng)
    return carpet


def _rub_off(carpet: Carpet, wear: Wear, rng: np.random.Generator) -> None:
    height, width = carpet.numbers.shape
    bare_px = max(1, round(wear.bare_m / carpet.metres_per_px))
    bare = rng.random((height // bare_px + 1, width // bare_px + 1)) < wear.worn
    bare = bare.repeat(bare_px, axis=0)[:height].repeat(bare_px, axis=1)[:, :width]
    carpet.numbers[bare & (carpet.numbers == _COLOURS.index(WHITE))] = _COLOURS.index(GREEN)


def _litter(carpet: Carpet, field: Field, wear: Wear, rng: np.random.Generator) -> None:
    inner = np.array((field.half_length_m + field.border_m, field.half_width_m + field.border_m)) + wear.speck_m
    outer = inner + _FLOOR_M
    count = round(4 * float(outer.prod()) * wear.clutter_1_m2)
    for x_m, y_m in (outer * rng.uniform(-1.0, 1.0, (count, 2))).tolist():
        if abs(x_m) > inner[0] or abs(y_m) > inner[1]:
            _paint(carpet, _circle(Point(x_m, y_m), wear.speck_m), WHITE)


def _lay_floor(numbers: NDArray[np.uint8], patch_px: int) -> None:
    height, width = numbers.shape
    for i, top in enumerate(range(0, height, patch_px)):
        for j, left in enumerate(range(0, width, patch_px)):
            patch = _PATCHES[(3 * i + 7 * j + i * j) % len(_PATCHES)]
            numbers[top : top + patch_px, left : left + patch_px] = _COLOURS.index(patch)


def _paint(carpet: Carpet, outline_m: Iterable[Point], colour: Bgr) -> None:
    outline = np.array(list(outline_m)) / carpet.metres_per_px + carpet.origin_px
    number = _COLOURS.index(colour)
    cv2.fillPoly(carpet.numbers, [np.round(outline * (1 << _SHIFT)).astype(np.int32)], (number,), shift=_SHIFT)


def _stripe(segment: Segment, width_m: float) -> list[Point]:
    (x0, y0), (x1, y1) = segment
    length_m = math.hypot(x1 - x0, y1 - y0)
    ux, uy = ((x1 - x0) / length_m * width_m / 2, (y1 - y0) / length_m * width_m / 2)
    return [
        Point(x0 - ux - uy, y0 - uy + ux),
        Point(x1 + ux - uy, y1 + uy + ux),
        Point(x1 + ux + uy, y1 + uy - ux),
        Point(x0 - ux + uy, y0 - uy - ux),
    ]


def _band(arc: Arc, width_m: float) -> list[Point]:
    angles = np.linspace(arc.start_rad, arc.end_rad, 2 + int((arc.end_rad - arc.start_rad) / _ARC_STEP_RAD))
    outer, inner = arc.radius_m + width_m / 2, arc.radius_m - width_m / 2
    return [_polar(arc.centre, outer, a) for a in angles] + [_polar(arc.centre, inner, a) for a in angles[::-1]]


def _circle(centre: Point, radius_m: float) -> list[Point]:
    return [_polar(centre, radius_m, a) for a in np.arange(0.0, 2 * math.pi, math.pi / 8)]


def _polar(centre: Point, radius_m: float, angle_rad: float) -> Point:
    return Point(centre.x_m + radius_m * math.cos(angle_rad), centre.y_m + radius_m * math.sin(angle_rad))
