"""The match drawn in characters."""

import math

import pytest

from lcmtypes.soccer import game_state_t, ground_truth_t, true_robot_t
from procs.view.field_drawing import field_drawing
from procs.view.scoreboard import GAME_STATE, TRUTH, drawing


def truth() -> ground_truth_t:
    made = ground_truth_t()
    for name, x_m, y_m in (("cyan1", -8.0, 0.5), ("magenta3", 5.0, -4.0)):
        robot = true_robot_t()
        robot.name, robot.x_m, robot.y_m = name, x_m, y_m
        made.robots.append(robot)
    made.n, made.ball_x_m, made.ball_y_m = 2, 2.0, 4.0
    return made


@pytest.mark.parametrize(("columns", "rows"), [(35, 13), (53, 30), (88, 34), (40, 5)])
def test_drawing_fits_and_shows_everything(columns: int, rows: int) -> None:
    lines = ["".join(text for text, _ in line) for line in field_drawing(truth(), columns, rows)]
    assert 0 < len(lines) <= rows
    assert {len(line) for line in lines} == {len(lines[0])}
    assert len(lines[0]) <= columns
    joined = "".join(lines)
    assert all(joined.count(letter) == 1 for letter in "13●")
    assert lines[0][0] == "┌"
    magenta = next(number for number, line in enumerate(lines) if "3" in line)
    ball = next(number for number, line in enumerate(lines) if "●" in line)
    assert ball < magenta  # y points up


def test_too_little_room_gives_no_drawing() -> None:
    assert field_drawing(truth(), 8, 3) == []


def test_before_the_first_message_there_is_no_drawing() -> None:
    assert drawing(lambda _: None, 40, 12) == []
    assert drawing({TRUTH: truth()}.get, 40, 12)


def test_robot_is_drawn_with_its_stated_number_and_team() -> None:
    made = truth()
    made.robots[0].name, made.robots[0].team, made.robots[0].number = "anna", "magenta", 4
    letters = [piece for line in field_drawing(made, 53, 30) for piece in line]
    style = next(style for text, style in letters if "4" in text)
    assert style == next(style for text, style in letters if "3" in text)


@pytest.mark.parametrize(("cyan_side", "left"), [(-1, "cyan1"), (1, "magenta3"), (0, "cyan1")])
def test_goals_have_the_colours_of_their_defenders(cyan_side: int, left: str) -> None:
    newest = {TRUTH: truth(), GAME_STATE: game_state_t(cyan_side=cyan_side)}
    letters = [piece for line in drawing(newest.get, 53, 30) for piece in line]
    goal = next(style for text, style in letters if "█" in text)
    assert goal == next(style for text, style in letters if left[-1] in text)


@pytest.mark.parametrize("value", [math.nan, math.inf, 1e300])
def test_places_that_cannot_be_are_not_drawn(value: float) -> None:
    world = truth()
    world.ball_x_m = world.robots[0].y_m = value
    letters = "".join(text for line in field_drawing(world, 53, 30) for text, _ in line)
    assert "3" in letters
    assert "●" not in letters
    assert "1" not in letters


@pytest.mark.parametrize("columns", [35, 53, 70, 88, 120])
def test_ball_in_the_goal_and_robots_beside_the_field_show(columns: int) -> None:
    made = truth()
    made.ball_x_m, made.ball_y_m = 11.5, 0.0
    made.robots[0].y_m, made.robots[1].y_m = -7.6, 7.9
    lines = ["".join(text for text, _ in line) for line in field_drawing(made, columns, 60)]
    assert any(line.endswith("●") for line in lines)
    assert "1" in lines[-1]
    assert "3" in lines[0]


def test_ball_on_the_centre_spot_lies_on_the_centre_line() -> None:
    made = truth()
    made.ball_x_m = made.ball_y_m = 0.0
    for columns in range(20, 90):
        lines = ["".join(text for text, _ in line) for line in field_drawing(made, columns, 60)]
        ball = next(line.index("●") for line in lines if "●" in line)
        assert lines[1][ball] == "│"


def test_robot_without_a_number_is_a_question_mark() -> None:
    made = truth()
    made.robots[0].name = "goalie"
    joined = "".join(text for line in field_drawing(made, 53, 30) for text, _ in line)
    assert "?" in joined
    assert "0" not in joined
