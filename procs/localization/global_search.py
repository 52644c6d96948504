"""Searches the whole field for the robot when only its approximate heading is known.

As on CAMBADA's robots, the search tries a grid of positions. Lines, grid and points are rounded to cells of one table.
The score of a position is therefore a sum of table entries, and a search takes well under a millisecond. The field
looks the same after half a turn, so the heading has to come from the compass.
"""

from functools import lru_cache

import numpy as np

from procs.localization.line_map import LineMap
from procs.localization.line_matching import LinePoints
from procs.model.frames import Floats

_CELL_M = 0.1  # width of a cell of the table
_STEP = 4  # cells from one position of the grid to the next
_LEAST_BEYOND_M = 0.4  # the grid reaches this far beyond the lines ...
_BESIDE_WALL_M = 0.6  # ... or, if that is further, to this distance from the wall; no further than robots see lines
_ROBUST_M = 0.35  # distance from a line at which a point scores half, so wide that the nearest position still scores


class GlobalSearch:
    """Scores every position of the grid for points within `reach_m` of the robot."""

    def __init__(self, lines: LineMap, reach_m: float) -> None:
        """Computes the table of scores and the grid of positions, with room for points beyond the grid."""
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
        """Returns the `count` best poses (count, 3), best first, no two nearer to each other than `apart_m`.

        Args:
            points: white points, robot frame.
            headings_rad: headings (n) to try.
            count: number of poses.
            apart_m: least distance of two poses along x or y.
        """
        scores = np.stack([self._scores(points, float(heading)) for heading in headings_rad])
        turn = scores.argmax(axis=0)
        score = scores.max(axis=0)
        found = np.empty((count, 3))
        for row in found:
            place = int(score.argmax())
            row[:2] = self._positions_m[place]
            row[2] = headings_rad[turn[place]]
            x_m, y_m = self._positions_m.T
            score[(np.abs(x_m - row[0]) < apart_m) & (np.abs(y_m - row[1]) < apart_m)] = -1.0
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
