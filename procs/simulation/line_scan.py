"""Points at which the scan lines of a robot cross the field's lines, by the truth."""

import math
from functools import lru_cache

import numpy as np

from procs.model.algebra import Floats
from procs.model.field import Field, Point
from procs.simulation.percept_errors import PerceptErrors
from procs.vision.colours import Mask
from procs.vision.mirror import Mirror

_PIECE_M = 0.1
_BARE = 0.5  # width of a place where paint is missing, as a share of the line's; as in pictures


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
        errors: PerceptErrors,
        rng: np.random.Generator,
    ) -> Floats:
        """Returns the points (n, 2) found on lines within reach, robot frame: by rays in equal angles, and by rings.

        A piece that spans half the angle between two rays is met by one of them with a probability of one half, one
        that spans the angle three times by three.
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
        met = np.floor(across_m / range_m * rays / math.tau + luck.take(near)).astype(np.intp)
        piece = np.repeat(np.arange(len(met)), met)
        number = np.arange(len(piece)) - np.repeat(met.cumsum() - met, met)
        share = (number + 0.5) / met[piece] - 0.5
        on_rings = np.nonzero(np.abs(range_m - np.array(rings_m, float)[:, None]) <= along_m / 2)[1]
        piece, share = np.concatenate((piece, on_rings)), np.concatenate((share, np.zeros(len(on_rings))))
        length_m = np.maximum(np.hypot(span_x_m, span_y_m), 1e-9)
        along_px_m, across_px_m = mirror.metres_per_px_each(range_m)
        pixel_m = np.hypot(along_px_m * across_m, across_px_m * along_m) / length_m
        found, aside_m = self._sampled(pixel_m[piece], errors, rng)
        piece, share, aside = piece[found], share[found], aside_m[found] / length_m[piece[found]]
        span_x_m, span_y_m = span_x_m[piece], span_y_m[piece]
        return np.column_stack(
            (x_m[piece] + share * span_x_m - aside * span_y_m, y_m[piece] + share * span_y_m + aside * span_x_m)
        )

    def _sampled(self, pixel_m: Floats, errors: PerceptErrors, rng: np.random.Generator) -> tuple[Mask, Floats]:
        """Returns which crossings (n) show white, and how far (n) the middle of that is from the line's.

        A line that is narrower than a pixel is met with the probability that the middle of a pixel lies on it; the
        place of a wider one is known to a pixel. Where paint is missing, the wider part of the line is left.

        Args:
            pixel_m: width of a pixel across the line, at each crossing.
            errors: missing paint, and blur.
            rng: draws luck.
        """
        bare, middle, met, white, phase = rng.random((5, len(pixel_m)))
        width_m, bare_m = self._width_m, _BARE * self._width_m
        left_m = np.abs(middle - 0.5) * (width_m + bare_m) + (width_m - bare_m) / 2  # beside the bare place
        worn = bare * bare_m < errors.worn * (width_m + bare_m)
        seen_m = np.where(worn, np.minimum(left_m, width_m), width_m)
        found = (met * pixel_m < seen_m) & (white * errors.line_blur_px * pixel_m <= width_m)
        aside_m = np.sign(middle - 0.5) * (seen_m - width_m) / 2 + (phase - 0.5) * np.minimum(pixel_m, seen_m)
        return found, aside_m


def _turned_back(x_m: Floats, y_m: Floats, cosine: float, sine: float) -> tuple[Floats, Floats]:
    """Returns vectors (n), given by x and y, turned clockwise by the angle with that cosine and sine."""
    return x_m * cosine + y_m * sine, y_m * cosine - x_m * sine


@lru_cache(maxsize=4)
def line_scan(field: Field) -> LineScan:
    """Returns the pieces of a field's lines, made once in each process."""
    return LineScan(field)
