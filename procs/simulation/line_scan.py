"""Points at which the scan lines of a robot cross the field's lines, by the truth."""

import math
from functools import lru_cache

import numpy as np

from procs.model.algebra import Floats
from procs.model.field import Field, Point
from procs.vision.mirror import Mirror

_PIECE_M = 0.1


class LineScan:
    """The field's lines in short pieces; each is met by the rays and rings that cross it."""

    def __init__(self, field: Field) -> None:
        starts, ends = [], []
        for segment in field.segments():
            cut = np.linspace(segment.start, segment.end, 1 + math.ceil(math.dist(*segment) / _PIECE_M))
            starts.append(cut[:-1])
            ends.append(cut[1:])
        for arc in field.arcs():
            turn_rad = arc.end_rad - arc.start_rad
            angles = np.linspace(arc.start_rad, arc.end_rad, 1 + math.ceil(turn_rad * arc.radius_m / _PIECE_M))
            around = arc.radius_m * np.column_stack((np.cos(angles), np.sin(angles))) + np.array(arc.centre)
            starts.append(around[:-1])
            ends.append(around[1:])
        self._width_m = field.line_width_m
        first, last = np.concatenate(starts), np.concatenate(ends)
        self._x_m, self._y_m = ((first + last) / 2).T.copy()  # of the middles; columns take a fraction of the time
        self._span_x_m, self._span_y_m = (last - first).T.copy()

    def points(
        self,
        place: Point,
        heading_rad: float,
        rays: int,
        rings_m: tuple[float, ...],
        reach_m: float,
        mirror: Mirror,
        rng: np.random.Generator,
    ) -> Floats:
        """Returns the crossings (n, 2) within reach, robot frame: of rays in equal angles, and of rings.

        A piece that spans half the angle between two rays is met by one of them with a probability of one half, one
        that spans the angle three times by three. A ray meets a line that is narrower than a pixel of the mirror's
        picture with the probability that the middle of a pixel lies on it.
        """
        cosine, sine = math.cos(heading_rad), math.sin(heading_rad)
        away_x_m, away_y_m = self._x_m - place.x_m, self._y_m - place.y_m
        luck = rng.random(len(away_x_m))
        near = np.flatnonzero(away_x_m**2 + away_y_m**2 < reach_m**2)
        x_m, y_m = _turned_back(away_x_m.take(near), away_y_m.take(near), cosine, sine)
        span_x_m, span_y_m = _turned_back(self._span_x_m.take(near), self._span_y_m.take(near), cosine, sine)
        range_m = np.maximum(np.hypot(x_m, y_m), 1e-6)
        across_m = np.abs(x_m * span_y_m - y_m * span_x_m) / range_m
        along_m = np.abs(x_m * span_x_m + y_m * span_y_m) / range_m
        pixel_m, _ = mirror.metres_per_px_each(range_m)
        length_m = np.hypot(span_x_m, span_y_m)
        shown = np.minimum(1.0, self._width_m * length_m / np.maximum(across_m * pixel_m, 1e-12))
        met = np.floor(shown * across_m / range_m * rays / math.tau + luck.take(near)).astype(np.intp)
        met += (np.abs(range_m - np.array(rings_m)[:, None]) <= along_m / 2).sum(axis=0)
        piece = np.repeat(np.arange(len(met)), met)
        number = np.arange(len(piece)) - np.repeat(met.cumsum() - met, met)
        share = (number + 0.5) / met[piece] - 0.5
        return np.column_stack((x_m[piece] + share * span_x_m[piece], y_m[piece] + share * span_y_m[piece]))


def _turned_back(x_m: Floats, y_m: Floats, cosine: float, sine: float) -> tuple[Floats, Floats]:
    """Returns vectors (n), given by x and y, turned clockwise by the angle with that cosine and sine."""
    return x_m * cosine + y_m * sine, y_m * cosine - x_m * sine


@lru_cache(maxsize=4)
def line_scan(field: Field) -> LineScan:
    """Returns the pieces of a field's lines, made once in each process."""
    return LineScan(field)
