"""The field's geometry against the dimensions in the rule book."""

import math

import pytest
from pydantic import ValidationError

from procs.model.field import SIDES, Field, Point

FIELD = Field()


def test_lines_lie_inside_the_field_and_are_symmetric() -> None:
    ends = {point for segment in FIELD.segments() for point in segment}
    assert max(point.x_m for point in ends) == pytest.approx(11.0 - 0.0625)
    assert max(point.y_m for point in ends) == pytest.approx(7.0 - 0.0625)
    assert {Point(-x, y) for x, y in ends} == ends == {Point(x, -y) for x, y in ends}


def test_field_has_seventeen_lines_five_arcs_and_nine_marks() -> None:
    assert (len(FIELD.segments()), len(FIELD.arcs()), len(FIELD.marks())) == (17, 5, 9)
    assert len(set(FIELD.marks())) == 9


def test_corner_arcs_bend_into_the_field() -> None:
    for arc in FIELD.arcs()[1:]:
        middle_rad = (arc.start_rad + arc.end_rad) / 2
        x_m = arc.centre.x_m + arc.radius_m * math.cos(middle_rad)
        y_m = arc.centre.y_m + arc.radius_m * math.sin(middle_rad)
        assert FIELD.in_field(x_m, y_m, -0.4)


def test_front_line_of_the_penalty_area_ends_with_the_area() -> None:
    fronts = [s for s in FIELD.segments() if s.start.x_m == s.end.x_m == pytest.approx(11.0 - 2.25 + 0.0625)]
    assert [(s.start.y_m, s.end.y_m) for s in fronts] == [pytest.approx((-3.45 + 0.0625, 3.45 - 0.0625))]


@pytest.mark.parametrize("side", SIDES)
def test_areas_and_goals(side: float) -> None:
    assert FIELD.in_penalty_area(side * 8.8, 3.4, side)
    assert not FIELD.in_penalty_area(side * 8.7, 0.0, side)
    assert FIELD.in_penalty_area(side * 8.7, 0.0, side, 0.1)
    assert not FIELD.in_penalty_area(side * 8.8, 0.0, -side)
    assert FIELD.in_goal_area(side * 10.3, 1.9, side)
    assert not FIELD.in_goal_area(side * 10.2, 0.0, side)
    assert FIELD.in_goal(side * 11.12, 0.0, side, 0.11)
    assert not FIELD.in_goal(side * 11.1, 0.0, side, 0.11)
    assert not FIELD.in_goal(side * 11.3, 1.21, side)
    assert FIELD.penalty_mark(side) in FIELD.marks()


def test_posts_leave_the_goal_width_free() -> None:
    left, right = FIELD.goal_posts(1.0)
    assert right.y_m - left.y_m - FIELD.post_diameter_m == pytest.approx(2.4)
    assert left.x_m == pytest.approx(10.9375)


def test_unknown_dimensions_are_refused() -> None:
    with pytest.raises(ValidationError, match="lenght_m"):
        Field.model_validate({"lenght_m": 18.0})


def test_ball_is_never_dropped_at_a_penalty_mark() -> None:
    field = Field()
    spots = field.restart_spots()
    assert len(spots) == 7
    assert not {field.penalty_mark(side) for side in SIDES} & set(spots)


@pytest.mark.parametrize(
    ("measures", "mistake"),
    [
        ({"corner_radius_m": 0.05}, "line_width_m of 0.125 m should be at most corner_radius_m, which is 0.05 m"),
        (
            {"circle_diameter_m": 0.2},
            "line_width_m of 0.125 m should be at most half of circle_diameter_m, which is 0.1 m",
        ),
        (
            {"goal_area_width_m": 0.125},
            "line_width_m of 0.125 m should be at most half of goal_area_width_m, which is 0.0625 m",
        ),
        (
            {"mark_diameter_m": 50.0},
            "mark_diameter_m of 50 m should be at most half of circle_diameter_m, which is 2 m",
        ),
        ({"post_diameter_m": 5.0}, "post_diameter_m of 5 m should be at most half of goal_width_m, which is 1.2 m"),
    ],
)
def test_lines_and_marks_that_cover_what_they_bound_are_refused(measures: dict[str, float], mistake: str) -> None:
    """With some of them tables of lines would be full of NaN, or all of the carpet white."""
    with pytest.raises(ValidationError) as raised:
        Field(**measures)
    assert mistake in str(raised.value)
