"""The match as a small drawing of letters for the terminal: field, robots by number, ball."""

from lcmtypes.soccer import ground_truth_t, true_robot_t
from procs.model.field import SIDES, Field
from procs.model.geometry import plausible
from procs.model.robot import number_in, team_in
from procs.model.teams import Ends

Line = list[tuple[str, str]]
"""Texts, each with its style in the words of rich."""

_GROUND = "on rgb(24,74,36)"
_PAINT = f"rgb(150,190,150) {_GROUND}"
_STYLES = {"cyan": f"bold rgb(90,230,255) {_GROUND}", "magenta": f"bold rgb(255,130,255) {_GROUND}"}
_BALL = f"bold rgb(255,190,60) {_GROUND}"
_HEIGHT_OF_WIDTH = 2.0  # height of a letter in a terminal, divided by its width
_LEAST_COLUMNS, _LEAST_ROWS = 12, 5  # a smaller drawing shows nothing useful


def field_drawing(
    truth: ground_truth_t, columns: int, rows: int, field: Field | None = None, ends: Ends | None = None
) -> list[Line]:
    """Returns the lines of the largest drawing that fits into `columns` and `rows`; none if that is too small.

    The world's x points to the right. What is beside the field, such as a ball in a goal, is drawn at its edge; a robot
    is the last digit of its number, or a question mark without one. Each goal has the colour of the team that defends
    it by `ends`.
    """
    measures = field or Field()
    length_m, width_m, border_m = measures.length_m, measures.width_m, measures.border_m
    height = min(rows, round(columns * width_m / length_m / _HEIGHT_OF_WIDTH))
    width = min(columns, round(height * length_m / width_m * _HEIGHT_OF_WIDTH))
    if width < _LEAST_COLUMNS or height < _LEAST_ROWS:
        return []
    goals = _goals(ends or Ends())
    letters = [[_ground(column, row, width, height, goals) for column in range(width)] for row in range(height)]

    def put(x_m: float, y_m: float, letter: str, style: str) -> None:
        if not plausible(x_m, y_m) or abs(x_m) > length_m / 2 + border_m or abs(y_m) > width_m / 2 + border_m:
            return
        column = round((x_m / length_m + 0.5) * (width - 1))
        row = round((0.5 - y_m / width_m) * (height - 1))
        letters[min(max(0, row), height - 1)][min(max(0, column), width - 1)] = (letter, style)

    for robot in truth.robots:
        put(robot.x_m, robot.y_m, *_robot(robot))
    put(truth.ball_x_m, truth.ball_y_m, "●", _BALL)
    return [_joined(line) for line in letters]


def _robot(robot: true_robot_t) -> tuple[str, str]:
    number = number_in(robot)
    return str(number)[-1] if number else "?", _STYLES.get(team_in(robot), _PAINT)


def _goals(ends: Ends) -> tuple[str, str]:
    """Returns the styles of the left and the right goal."""
    left, right = (_STYLES[ends.defender(side).name.lower()] for side in SIDES)
    return left, right


def _ground(column: int, row: int, width: int, height: int, goals: tuple[str, str]) -> tuple[str, str]:
    """Returns letter and style of the empty field at a place of the drawing; `goals` are the styles of the goals."""
    top, bottom, left, right = row == 0, row == height - 1, column == 0, column == width - 1
    if (left or right) and abs(row - (height - 1) / 2) <= max(0.5, height / 12):
        return "█", goals[0 if left else 1]
    if (left or right) and (top or bottom):
        return {(True, True): "┌", (True, False): "┐", (False, True): "└", (False, False): "┘"}[top, left], _PAINT
    if top or bottom:
        return "─", _PAINT
    if left or right or column == round(0.5 * (width - 1)):
        return "│", _PAINT
    return " ", _GROUND


def _joined(letters: Line) -> Line:
    """Joins neighbouring letters of one style."""
    line: Line = []
    for letter, style in letters:
        if line and line[-1][1] == style:
            line[-1] = (line[-1][0] + letter, style)
        else:
            line.append((letter, style))
    return line
