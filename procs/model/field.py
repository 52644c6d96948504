"""The field of the middle size league: its measures, lines, marks and goals.

World frame: origin in the centre, x towards the goal that magenta defends in the first half, y to the left of x,
metres. A `side` is -1.0 for the half and goal of cyan in the first half, and +1.0 for those of magenta. The letters
and their measures are those of the field drawing in the rule book of 2023 (24.1), as MRA-components has them; field
and areas are measured to the outer edges of their lines.
"""

import math
from typing import Annotated, Any, NamedTuple

from pydantic import BaseModel, ConfigDict, ValidationInfo, field_validator
from pydantic import Field as Setting

from fwk import Alike

SIDES = (-1.0, 1.0)

Measure = Annotated[float, Setting(gt=0.0, le=100.0)]
"""A measure of the field in metres."""

_LIMITS: dict[str, tuple[tuple[str, float], ...]] = {
    "penalty_area_width_m": (("width_m", 1.0),),
    "penalty_area_depth_m": (("length_m", 0.5),),
    "goal_area_width_m": (("penalty_area_width_m", 1.0),),
    "goal_area_depth_m": (("penalty_area_depth_m", 1.0),),
    "corner_radius_m": (("width_m", 0.5),),
    "circle_diameter_m": (("width_m", 1.0),),
    "penalty_mark_distance_m": (("length_m", 0.5),),
    "mark_diameter_m": (("circle_diameter_m", 0.5),),
    "line_width_m": (
        ("goal_area_depth_m", 0.5),
        ("goal_area_width_m", 0.5),
        ("corner_radius_m", 1.0),
        ("circle_diameter_m", 0.5),
    ),
    "restart_offset_m": (("width_m", 0.5),),
    "goal_width_m": (("width_m", 1.0),),
    "goal_depth_m": (("border_m", 1.0),),
    "post_diameter_m": (("goal_width_m", 0.5),),
}
"""Measure to upper limits: pairs of another measure, declared before it, and the largest allowed share of that."""


class Point(NamedTuple):
    """A point on the ground in metres."""

    x_m: float
    y_m: float


class Segment(NamedTuple):
    """The middle of a straight line from one end to the other; its paint reaches half a line width further."""

    start: Point
    end: Point


class Arc(NamedTuple):
    """The middle of a line that is part of a circle, counter-clockwise from the start angle to the end angle."""

    centre: Point
    radius_m: float
    start_rad: float
    end_rad: float


class Field(BaseModel):
    """Measures of the field, and the geometry that follows from them; all in metres."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, validate_default=True)

    length_m: Measure = 22.0
    """Length A of the field along x, over the outer edges of the goal lines, in metres."""
    width_m: Measure = 14.0
    """Width B of the field along y, over the outer edges of the touch lines, in metres."""
    penalty_area_width_m: Measure = 6.9
    """Width C of the penalty areas along y, in metres."""
    penalty_area_depth_m: Measure = 2.25
    """Depth E of the penalty areas from the goal line into the field, in metres."""
    goal_area_width_m: Measure = 3.9
    """Width D of the goal areas along y, in metres."""
    goal_area_depth_m: Measure = 0.75
    """Depth F of the goal areas from the goal line into the field, in metres."""
    corner_radius_m: Measure = 0.75
    """Radius G of the quarter circles in the corners, in metres."""
    circle_diameter_m: Measure = 4.0
    """Diameter H of the centre circle, in metres."""
    penalty_mark_distance_m: Measure = 3.6
    """Distance I from the goal line to the penalty mark, in metres."""
    mark_diameter_m: Measure = 0.15
    """Diameter J of the centre mark, the penalty marks and the restart marks, in metres."""
    line_width_m: Measure = 0.125
    """Width K of every line, in metres."""
    border_m: Measure = 1.0
    """Distance L from the field to the low wall around it, in metres."""
    team_area_width_m: float = Setting(1.0, ge=0.0, le=100.0)
    """Width M of the technical team areas beside the border, in metres."""
    team_area_length_m: float = Setting(7.5, ge=0.0, le=100.0)
    """Length N of the technical team areas, in metres."""
    ramp_length_m: float = Setting(1.0, ge=0.0, le=100.0)
    """Length O of the ramps into the team areas, in metres."""
    ramp_width_m: float = Setting(0.5, ge=0.0, le=100.0)
    """Width P of the ramps into the team areas, in metres."""
    restart_offset_m: Measure = 3.5
    """Distance Q from the middle of the field to the restart marks beside it, in metres."""
    goal_width_m: Measure = 2.4
    """Clear width of the goals between the posts, in metres. Falcons; the rule book of 2016 has 2.0 m."""
    goal_depth_m: Measure = 0.6
    """Depth of the goals from the outer edge of the goal line to the net, in metres. 2016: 0.5 m or more."""
    goal_height_m: Measure = 1.0
    """Clear height of the goals under the bar, in metres. Rule book of 2016."""
    post_diameter_m: Measure = 0.125
    """Diameter of the round goal posts, in metres. Rule book of 2016."""

    @field_validator(*_LIMITS)
    @classmethod
    def _fits(cls, measure_m: float, info: ValidationInfo) -> float:
        """Refuses measures that do not fit into others, which are checked before them."""
        assert info.field_name
        for larger, share in _LIMITS[info.field_name]:
            if larger in info.data and measure_m > share * info.data[larger]:
                part = larger if share == 1.0 else f"half of {larger}"
                largest_m = share * info.data[larger]
                raise ValueError(
                    f"{info.field_name} of {measure_m:g} m should be at most {part}, which is {largest_m:g} m"
                )
        return measure_m

    @property
    def half_length_m(self) -> float:
        """Distance from the centre to the outer edge of a goal line, in metres."""
        return self.length_m / 2

    @property
    def half_width_m(self) -> float:
        """Distance from the centre to the outer edge of a touch line, in metres."""
        return self.width_m / 2

    @property
    def goal_plane_m(self) -> float:
        """Distance from the centre to the plane in which the posts and the bar of a goal stand, in metres."""
        return self.half_length_m - self.line_width_m / 2

    @property
    def bar_top_m(self) -> float:
        """Height of the upper side of the bars, in metres; the lower side is at `goal_height_m`."""
        return self.goal_height_m + self.post_diameter_m

    def segments(self) -> list[Segment]:
        """Returns the middles of all straight lines."""
        inset_m = self.line_width_m / 2
        x_m, y_m = self.half_length_m - inset_m, self.half_width_m - inset_m
        lines = [Segment(Point(0.0, -y_m), Point(0.0, y_m))]
        lines += [Segment(Point(-x_m, side * y_m), Point(x_m, side * y_m)) for side in SIDES]
        for side in SIDES:
            lines.append(Segment(Point(side * x_m, -y_m), Point(side * x_m, y_m)))
            for width_m, depth_m in (
                (self.penalty_area_width_m, self.penalty_area_depth_m),
                (self.goal_area_width_m, self.goal_area_depth_m),
            ):
                front_m, flank_m = side * (self.half_length_m - depth_m + inset_m), width_m / 2 - inset_m
                lines.append(Segment(Point(front_m, -flank_m), Point(front_m, flank_m)))
                lines += [Segment(Point(side * x_m, end * flank_m), Point(front_m, end * flank_m)) for end in SIDES]
        return lines

    def arcs(self) -> list[Arc]:
        """Returns the middles of all round lines: the centre circle, then the quarter circles in the corners."""
        inset_m, quarter = self.line_width_m / 2, math.pi / 2
        arcs = [Arc(Point(0.0, 0.0), self.circle_diameter_m / 2 - inset_m, 0.0, 2 * math.pi)]
        for turns, (x, y) in enumerate(((-1, -1), (1, -1), (1, 1), (-1, 1))):
            corner = Point(x * self.half_length_m, y * self.half_width_m)
            arcs.append(Arc(corner, self.corner_radius_m - inset_m, turns * quarter, (turns + 1) * quarter))
        return arcs

    def marks(self) -> list[Point]:
        """Returns the middles of the painted spots: centre, penalty marks, restart marks."""
        rows_m = [side * (self.half_length_m - self.penalty_mark_distance_m) for side in SIDES]
        offsets_m = (-self.restart_offset_m, 0.0, self.restart_offset_m)
        return [Point(x_m, y_m) for x_m in (0.0, *rows_m) for y_m in offsets_m]

    def restart_spots(self) -> list[Point]:
        """Returns the marks for dropped balls: the centre and the restart marks, without the penalty marks."""
        return [mark for mark in self.marks() if mark.y_m or not mark.x_m]

    def penalty_mark(self, side: float) -> Point:
        """Returns the mark for penalties against a side."""
        return Point(side * (self.half_length_m - self.penalty_mark_distance_m), 0.0)

    def goal_centre(self, side: float) -> Point:
        """Returns the middle of the goal mouth, on the outer edge of the goal line."""
        return Point(side * self.half_length_m, 0.0)

    def goal_posts(self, side: float) -> tuple[Point, Point]:
        """Returns the middles of the two posts, which stand on the goal line; negative y first."""
        x_m = side * self.goal_plane_m
        y_m = (self.goal_width_m + self.post_diameter_m) / 2
        return Point(x_m, -y_m), Point(x_m, y_m)

    def in_field(self, x_m: float, y_m: float, margin_m: float = 0.0) -> bool:
        """Returns whether a point is on the field, lines included; a positive margin makes the field larger."""
        return abs(x_m) <= self.half_length_m + margin_m and abs(y_m) <= self.half_width_m + margin_m

    def in_penalty_area(self, x_m: float, y_m: float, side: float, margin_m: float = 0.0) -> bool:
        """Returns whether a point is in a side's penalty area, lines included; a positive margin makes it larger."""
        return self._in_area(x_m, y_m, side, self.penalty_area_width_m, self.penalty_area_depth_m, margin_m)

    def in_goal_area(self, x_m: float, y_m: float, side: float, margin_m: float = 0.0) -> bool:
        """Returns whether a point is in a side's goal area, lines included; a positive margin makes it larger."""
        return self._in_area(x_m, y_m, side, self.goal_area_width_m, self.goal_area_depth_m, margin_m)

    def in_goal(self, x_m: float, y_m: float, side: float, ball_radius_m: float = 0.0) -> bool:
        """Returns whether a ball of that radius (0: a point) is wholly behind a side's goal line and in the goal."""
        behind_m = side * x_m - self.half_length_m
        return ball_radius_m < behind_m <= self.goal_depth_m and abs(y_m) < self.goal_width_m / 2

    def _in_area(self, x_m: float, y_m: float, side: float, width_m: float, depth_m: float, margin_m: float) -> bool:
        from_goal_line_m = self.half_length_m - side * x_m
        return -margin_m <= from_goal_line_m <= depth_m + margin_m and abs(y_m) <= width_m / 2 + margin_m


MatchField = Annotated[Field, Alike]
"""Measures of the field as a setting: a match has one field."""


def field_of(measures: Any) -> Field:
    """Returns the field of a message that has the measures as members, without a check."""
    return Field.model_construct(**{name: getattr(measures, name) for name in Field.model_fields})
