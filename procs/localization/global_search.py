"""Looks for the robot on the whole field when only its heading is known, roughly.

As on CAMBADA's robots the field is searched on a grid of positions. Lines, grid and points are rounded to
cells of one table, so that a position's score is a sum of table entries and the whole field takes well under a
millisecond. Turned by half a turn the field looks the same; that is why the compass has to say the heading.
"""

from functools import lru_cache

import numpy as np

from procs.localization.line_map import LineMap
from procs.localization.line_matching import LinePoints
from procs.model.frames import Floats

_CELL_M = 0.1  # of the table
_STEP = 4  # cells from one position of the grid to the next
_LEAST_BEYOND_M = 0.4  # so far beyond the lines there are positions, ...
_BESIDE_WALL_M = 0.6  # ... and up to this distance from a wall further away, as far as robots see lines
_ROBUST_M = 0.35  # distance from a line at which a point scores half: the nearest position of the grid still scores


class GlobalSearch:
    """Scores every position of the grid for points within `reach_m` of the robot."""

    def __init__(self, lines: LineMap, reach_m: float) -> None:
        field = lines.field
        beyond_m = max(_LEAST_BEYOND_M, min(field.border_m, reach_m) - _BESIDE_WALL_M)
        half_x = round((field.half_length_m + beyond_m) / _CELL_M)
        half_y = round((field.half_width_m + beyond_m) / _CELL_M)
        pad = int(reach_m / _CELL_M) + 2
        columns = np.arange(-half_x - pad, half_x + pad + 1)
        rows = np.arange(-half_y - pad, half_y + pad + 1)
        x_m, y_m = np.meshgrid(columns * _CELL_M, rows * _CELL_M)
        distance_m, _, _ = lines.look_up(x_m, y_m)
        self._width = len(columns)
        self._table = (_ROBUST_M**2 / (_ROBUST_M**2 + distance_m**2)).astype(np.float32).ravel()
        grid_x, grid_y = np.meshgrid(np.arange(-half_x, half_x + 1, _STEP), np.arange(-half_y, half_y + 1, _STEP))
        self._positions_m = np.column_stack((grid_x.ravel(), grid_y.ravel())) * _CELL_M
        self._starts = (grid_y.ravel() + half_y + pad) * self._width + grid_x.ravel() + half_x + pad

    def best(self, points: LinePoints, headings_rad: Floats, count: int, apart_m: float = 1.0) -> Floats:
        """Returns the `count` best poses (count, 3), best first, no two nearer to each other than `apart_m`."""
        scores = np.stack([self._scores(points, float(heading)) for heading in headings_rad])
        turn = scores.argmax(axis=0)
        score = scores.max(axis=0)
        found = np.empty((count, 3))
        for row in found:
            place = int(score.argmax())
            row[:2] = self._positions_m[place]
            row[2] = headings_rad[turn[place]]
            score[np.abs(self._positions_m - row[:2]).max(axis=1) < apart_m] = -1.0
        return found

    def _scores(self, points: LinePoints, heading_rad: float) -> Floats:
        cosine, sine = np.cos(heading_rad), np.sin(heading_rad)
        column = np.rint((cosine * points.x_m - sine * points.y_m) / _CELL_M).astype(np.intp)
        row = np.rint((sine * points.x_m + cosine * points.y_m) / _CELL_M).astype(np.intp)
        entries = self._table.take((row * self._width + column)[:, None] + self._starts)
        return np.asarray(points.trust.astype(np.float32) @ entries, dtype=np.float64)


@lru_cache(maxsize=4)
def global_search(lines: LineMap, reach_m: float) -> GlobalSearch:
    """Returns the search in a table of lines, made once in each process."""
    return GlobalSearch(lines, reach_m)
