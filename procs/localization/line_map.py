"""The field's white lines as a table: for every place the signed distance to the nearest line, and its direction.

The table follows Lauer, Lange and Riedmiller ("Calculating the Perfect Match", RoboCup 2005), with one difference:
distances are signed, and each cell is a plane, given by the distance and the unit normal at its middle. With cells as
large as 5 cm, the residual is therefore smooth across a line and exact beside a straight one.
"""

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from procs.model.field import Arc, Field, Point, Segment
from procs.model.frames import Floats

_BLOCK_M = 0.5  # width of the blocks that share their candidates for the nearest line
_MARGIN_M = 1.5  # beyond the field, so that points there still pull towards the touch lines


class LineMap:
    """Distance to the middle of the nearest line or mark."""

    def __init__(self, field: Field, cell_m: float = 0.05) -> None:
        """Computes the table of a field, with square cells of the width `cell_m`."""
        self.field = field
        self._cell_m = cell_m
        self._left_m = -field.half_length_m - _MARGIN_M
        self._bottom_m = -field.half_width_m - _MARGIN_M
        self._columns = round(-2 * self._left_m / cell_m)
        self._rows = round(-2 * self._bottom_m / cell_m)
        x_m = self._left_m + (np.arange(self._columns) + 0.5) * cell_m
        y_m = self._bottom_m + (np.arange(self._rows) + 0.5) * cell_m
        centres_m = np.stack(np.meshgrid(x_m, y_m), axis=-1).reshape(-1, 2)
        self._table = _nearest(field, centres_m)

    def look_up(self, x_m: Floats, y_m: Floats) -> tuple[Floats, Floats, Floats]:
        """Returns signed distances in metres and the unit vectors along which they grow, for places of the world frame.

        The arrays may have any shape; the three results have the same. The sign says on which side of the line a place
        is, but which side counts as positive has no meaning.
        """
        across, up = (x_m - self._left_m) / self._cell_m, (y_m - self._bottom_m) / self._cell_m
        column, row = _clipped(across, self._columns), _clipped(up, self._rows)
        cells = self._table.take(row * self._columns + column, axis=0)
        normal_x, normal_y = cells[..., 1], cells[..., 2]
        beside_m = self._cell_m * (normal_x * (across - (column + 0.5)) + normal_y * (up - (row + 0.5)))
        return cells[..., 0] + beside_m, normal_x, normal_y


@lru_cache(maxsize=4)
def line_map(field: Field) -> LineMap:
    """Returns the table of a field, made once in each process."""
    return LineMap(field)


def _clipped(cells: Floats, count: int) -> NDArray[np.intp]:
    return np.minimum(np.maximum(cells, 0), count - 1).astype(np.intp)


def _nearest(field: Field, places_m: Floats) -> Floats:
    """Returns signed distance and unit normal (n, 3) of the line or mark that is nearest to each place (n, 2).

    Places are grouped in square blocks. For a block, only those lines are compared that can be nearest somewhere in it:
    their distance from its middle exceeds that of the nearest line by at most twice the way from middle to corner.
    """
    shapes: list[Callable[[Floats], Floats]] = [partial(_to_segment, segment) for segment in field.segments()]
    shapes += [partial(_to_arc, arc) for arc in field.arcs()]
    shapes += [partial(_from_point, mark) for mark in field.marks()]
    first_m = places_m.min(axis=0)
    in_column, in_row = ((places_m - first_m) / _BLOCK_M).astype(np.intp).T
    columns, rows = in_column.max() + 1, in_row.max() + 1
    middles_m = first_m + (np.indices((columns, rows)).reshape(2, -1).T + 0.5) * _BLOCK_M
    from_middle_m = np.stack([np.abs(shape(middles_m)[:, 0]) for shape in shapes])
    candidates = from_middle_m <= from_middle_m.min(axis=0) + 1.01 * np.sqrt(2) * _BLOCK_M
    block = in_column * rows + in_row
    best = np.full((len(places_m), 3), np.inf)
    for shape, in_blocks in zip(shapes, candidates, strict=True):
        here = np.flatnonzero(in_blocks[block])
        other = shape(places_m[here])
        nearer = np.abs(other[:, 0]) < np.abs(best[here, 0])
        best[here[nearer]] = other[nearer]
    return best


def _to_segment(segment: Segment, places_m: Floats) -> Floats:
    """Returns signed distance and unit normal (n, 3) from a segment to places (n, 2)."""
    start = np.array(segment.start)
    along = np.array(segment.end) - start
    length_m = float(np.hypot(*along))
    along /= length_m
    normal = np.array([-along[1], along[0]])
    beside_m = (places_m - start) @ normal
    foot_m = (places_m - start) @ along
    signed = np.column_stack((beside_m, np.tile(normal, (len(places_m), 1))))
    for beyond, end in ((foot_m < 0.0, segment.start), (foot_m > length_m, segment.end)):
        signed[beyond] = _from_point(end, places_m[beyond])
    return signed


def _to_arc(arc: Arc, places_m: Floats) -> Floats:
    """Returns signed distance and unit normal (n, 3) from an arc to places (n, 2)."""
    signed = _from_point(arc.centre, places_m)
    signed[:, 0] -= arc.radius_m
    angle_rad = np.arctan2(signed[:, 2], signed[:, 1])
    width_rad = arc.end_rad - arc.start_rad
    outside = np.mod(angle_rad - arc.start_rad, 2 * np.pi) > width_rad + 1e-9
    for end_rad in (arc.start_rad, arc.end_rad):
        end = Point(
            arc.centre.x_m + arc.radius_m * float(np.cos(end_rad)),
            arc.centre.y_m + arc.radius_m * float(np.sin(end_rad)),
        )
        other = _from_point(end, places_m)
        nearer = outside & ((np.abs(other[:, 0]) < np.abs(signed[:, 0])) | (end_rad == arc.start_rad))
        signed[nearer] = other[nearer]
    return signed


def _from_point(point: Point, places_m: Floats) -> Floats:
    """Returns distance and unit vector (n, 3) from a point to places (n, 2)."""
    away_m = places_m - np.array(point)
    distance_m = np.hypot(away_m[:, 0], away_m[:, 1])
    return np.column_stack((distance_m, away_m / np.maximum(distance_m, 1e-9)[:, None]))
