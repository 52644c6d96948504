"""Draws the empty field: grass, lines, marks and goals."""

import math

from procs.model.field import SIDES, Arc, Field, Point
from procs.model.geometry import ahead
from procs.view.canvas import Canvas, Colour

GRASS: tuple[Colour, Colour] = ((64, 128, 48), (58, 118, 44))
SURROUND: Colour = (48, 92, 36)
WHITE: Colour = (240, 244, 240)
NET: Colour = (150, 160, 150)
POST: Colour = (250, 250, 250)

_STRIPES = 12
_ARC_STEPS = 48


def draw_ground(canvas: Canvas, field: Field) -> None:
    """Draws grass, lines, marks and goals over the whole picture."""
    x_m, y_m = field.half_length_m, field.half_width_m
    canvas.picture[:] = SURROUND
    stripe_m = field.length_m / _STRIPES
    for stripe in range(_STRIPES):
        left_m = -x_m + stripe * stripe_m
        right_m = left_m + stripe_m
        canvas.polygon([(left_m, -y_m), (right_m, -y_m), (right_m, y_m), (left_m, y_m)], GRASS[stripe % 2])
    for side in SIDES:
        _draw_goal(canvas, field, side)
    for segment in field.segments():
        canvas.line(segment.start, segment.end, field.line_width_m, WHITE)
    for arc in field.arcs():
        whole = arc.end_rad - arc.start_rad > math.pi
        cap_rad = 0.0 if whole else field.line_width_m / arc.radius_m  # the round ends must not leave the field
        canvas.polyline(arc_places(arc, _ARC_STEPS, cap_rad), field.line_width_m, WHITE)
    for mark in field.marks():
        canvas.disc(mark, field.mark_diameter_m / 2, WHITE)
    for side in SIDES:
        for post in field.goal_posts(side):
            canvas.disc(post, field.post_diameter_m / 2 + 0.04, SURROUND)
            canvas.disc(post, field.post_diameter_m / 2, POST)


def arc_places(arc: Arc, steps: int, cap_rad: float = 0.0) -> list[Point]:
    """Returns `steps` + 1 places on an arc at equal angles; the first and the last are `cap_rad` inside its ends.

    All are the middle of an arc that is shorter than two caps.
    """
    cap_rad = min(cap_rad, (arc.end_rad - arc.start_rad) / 2)
    turn_rad = (arc.end_rad - arc.start_rad - 2 * cap_rad) / steps
    angles = (arc.start_rad + cap_rad + step * turn_rad for step in range(steps + 1))
    return [ahead(arc.centre, angle, arc.radius_m) for angle in angles]


def _draw_goal(canvas: Canvas, field: Field, side: float) -> None:
    front_m, half_m = side * field.half_length_m, field.goal_width_m / 2
    back_m = front_m + side * field.goal_depth_m
    mesh_m = field.goal_depth_m / 4
    for row in range(5):
        x_m = front_m + side * row * mesh_m
        canvas.line((x_m, -half_m), (x_m, half_m), 0.01, NET)
    columns = max(1, round(field.goal_width_m / mesh_m))
    for column in range(columns + 1):
        y_m = -half_m + column * field.goal_width_m / columns
        canvas.line((front_m, y_m), (back_m, y_m), 0.01, NET)
