"""Judge of the lines: notices when the ball leaves the field."""

from procs.model.events import Kind
from procs.model.field import SIDES, Field


class LineJudge:
    """Reports the ball's leaving of the field, once each time."""

    def __init__(self, field: Field, ball_radius_m: float) -> None:
        self.ball_in_field = True
        self._put_down = False
        self._field = field
        self._radius_m = ball_radius_m

    def put_down(self, x_m: float, y_m: float) -> None:
        """Takes the place of a ball that was put down: outside the field it has left it, wherever it was before."""
        self.ball_in_field = self._field.in_field(x_m, y_m, self._radius_m)
        self._put_down = True

    def judge(self, x_m: float, y_m: float, under_bar: bool) -> Kind | None:
        """Returns the event of a ball that is now here: a goal, if it has come under a bar, out, or None."""
        was_in_field, self._put_down = self.ball_in_field or self._put_down, False
        self.ball_in_field = self._field.in_field(x_m, y_m, self._radius_m)
        if self.ball_in_field or not was_in_field:
            return None
        if under_bar and any(self._field.in_goal(x_m, y_m, side, self._radius_m) for side in SIDES):
            return Kind.GOAL
        return Kind.OUT_SIDE if abs(y_m) > self._field.half_width_m + self._radius_m else Kind.OUT_END
