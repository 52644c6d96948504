"""The match seen from above: field, robots, ball, score and, on demand, the beliefs of the robots."""

import math
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

import numpy as np

from lcmtypes.soccer import game_state_t, ground_truth_t, true_robot_t, world_model_t
from procs.model.ball import BALL as BALL_MODEL
from procs.model.ball import BallModel
from procs.model.field import Field, Point
from procs.model.geometry import ahead, plausible
from procs.model.robot import ROBOT, RobotModel, number_in, team_in
from procs.view.beliefs import draw_beliefs
from procs.view.canvas import Canvas, Colour, write
from procs.view.ground import draw_ground
from procs.view.measures import field_in, recent, settings_in
from procs.view.palette import TEAM_COLOURS, UNKNOWN_TEAM
from procs.view.scoreboard import GAME_STATE, TRUTH, phase, play_time
from procs.vision.colours import Picture

BODY: Colour = (38, 34, 32)
EDGE: Colour = (84, 78, 74)
SHADOW: Colour = (40, 78, 30)
BALL: Colour = (30, 196, 250)
BALL_EDGE: Colour = (20, 90, 130)
BAR: Colour = (32, 28, 26)
TEXT: Colour = (245, 245, 245)

_TAIL_S = 0.12  # the ball's tail shows the way of this time
_HIGHER = (0.3, -0.4)  # shift of a flying ball's shadow for each metre of height
_VIEWS = 4  # number of fields whose pictures are kept
_MARKER = 0.64  # radius of the team marker, as a share of the robot's


class TopView:
    """Draws pictures of one size; the world's x points to the right."""

    def __init__(
        self,
        width_px: int = 1280,
        field: Field | None = None,
        robot: RobotModel = ROBOT,
        ball: BallModel = BALL_MODEL,
    ) -> None:
        """Derives the height from the field; width and height are even, as video encoders require."""
        self._radius_m, self._ball_radius_m = robot.radius_m, ball.radius_m
        self._mouth_rad = math.radians(robot.mouth_half_angle_deg)
        self._field = field or Field()
        margin_m = self._field.border_m
        self._bar_px = round(width_px / 24)
        scale = width_px / (self._field.length_m + 2 * margin_m)
        height_px = self._bar_px + (self._field.width_m + 2 * margin_m) * scale
        self.width_px, self.height_px = 2 * round(width_px / 2), 2 * round(height_px / 2)
        ground: Picture = np.zeros((self.height_px, self.width_px, 3), np.uint8)
        middle_px = (self.width_px / 2, (self.height_px + self._bar_px) / 2)
        self._canvas = Canvas(ground, middle_px, scale)
        draw_ground(self._canvas, self._field)

    def draw(
        self,
        truth: ground_truth_t,
        state: game_state_t | None = None,
        beliefs: Mapping[str, world_model_t] | None = None,
    ) -> Picture:
        """Returns a picture of the world; `beliefs` are the world models of some robots, by namespace."""
        canvas = self._canvas.on(self._canvas.picture.copy())
        teams = {robot.name: team_in(robot) for robot in truth.robots}
        for name, belief in sorted((beliefs or {}).items()):
            draw_beliefs(canvas, teams.get(name, ""), belief, self._radius_m)
        for robot in truth.robots:
            if plausible(robot.x_m, robot.y_m, robot.heading_rad):
                self._draw_robot(canvas, robot)
        self._draw_ball(canvas, truth)
        self._draw_bar(canvas.picture, state)
        return canvas.picture

    def _draw_robot(self, canvas: Canvas, robot: true_robot_t) -> None:
        place, radius_m = Point(robot.x_m, robot.y_m), self._radius_m
        canvas.disc((robot.x_m + 0.04, robot.y_m - 0.05), radius_m, SHADOW)
        canvas.polygon(_outline(robot, radius_m, self._mouth_rad), EDGE)
        canvas.polygon(_outline(robot, 0.88 * radius_m, self._mouth_rad), BODY)
        canvas.disc(place, _MARKER * radius_m, TEAM_COLOURS.get(team_in(robot), UNKNOWN_TEAM))
        base, nose = (ahead(place, robot.heading_rad, share * radius_m) for share in (_MARKER, 0.96))
        canvas.line(base, nose, 0.2 * radius_m, TEXT)
        number = number_in(robot)
        canvas.text(str(number) if number else "?", place, 0.72 * radius_m, TEXT)

    def _draw_ball(self, canvas: Canvas, truth: ground_truth_t) -> None:
        tail = (truth.ball_x_m - _TAIL_S * truth.ball_vx_m_s, truth.ball_y_m - _TAIL_S * truth.ball_vy_m_s)
        place, radius_m = (truth.ball_x_m, truth.ball_y_m), self._ball_radius_m
        right_m, up_m = 0.03 + _HIGHER[0] * truth.ball_z_m, -0.04 + _HIGHER[1] * truth.ball_z_m
        canvas.disc((place[0] + right_m, place[1] + up_m), radius_m, SHADOW)
        canvas.line(tail, place, 0.05, BALL)
        canvas.disc(place, radius_m, BALL_EDGE)
        canvas.disc(place, 0.77 * radius_m, BALL)

    def _draw_bar(self, picture: Picture, state: game_state_t | None) -> None:
        picture[: self._bar_px] = BAR
        if state is None:
            return
        size_px, middle_px, y_px = self._bar_px * 0.42, self.width_px / 2, self._bar_px / 2
        gap_px = self._bar_px * 1.3
        write(picture, f"{state.score_cyan} : {state.score_magenta}", (middle_px, y_px), size_px, TEXT)
        write(picture, "CYAN", (middle_px - gap_px, y_px), size_px, TEAM_COLOURS["cyan"], align=1.0)
        write(picture, "MAGENTA", (middle_px + gap_px, y_px), size_px, TEAM_COLOURS["magenta"], align=0.0)
        small_px, edge_px = size_px * 0.7, self._bar_px * 0.5
        clock = f"half {state.half}   {play_time(state.time_in_half_s)}"
        write(picture, clock, (edge_px, y_px), small_px, TEXT, align=0.0)
        write(picture, phase(state), (self.width_px - edge_px, y_px), small_px, TEXT, align=1.0)


def picture(newest: Callable[[str], Any]) -> Picture | None:
    """Draws a running or recorded match from its newest decoded messages; None before the first ground truth."""
    truth = newest(TRUTH)
    return None if truth is None else _view_of(newest).draw(truth, newest(GAME_STATE))


def picture_with_beliefs(newest: Callable[[str], Any]) -> Picture | None:
    """Draws the same picture as `picture`, with the beliefs of every robot about itself and the ball."""
    truth = newest(TRUTH)
    if truth is None:
        return None
    models = {robot.name: recent(newest(f"{robot.name}/world_model"), truth) for robot in truth.robots}
    beliefs = {name: model for name, model in models.items() if model is not None}
    return _view_of(newest).draw(truth, newest(GAME_STATE), beliefs)


def _view_of(newest: Callable[[str], Any]) -> TopView:
    robot, ball = settings_in(newest, "robot"), settings_in(newest, "ball")
    return _view(field_in(newest), RobotModel.model_construct(**robot), BallModel.model_construct(**ball))


@lru_cache(maxsize=_VIEWS)
def _view(field: Field, robot: RobotModel, ball: BallModel) -> TopView:
    return TopView(field=field, robot=robot, ball=ball)


def _outline(robot: true_robot_t, radius_m: float, mouth_rad: float) -> list[tuple[float, float]]:
    """Returns the outline of a robot in metres: a circle whose front is cut off at the mouth."""
    steps = 24
    span_rad = 2 * math.pi - 2 * mouth_rad
    angles = [robot.heading_rad + mouth_rad + span_rad * step / steps for step in range(steps + 1)]
    return [(robot.x_m + radius_m * math.cos(angle), robot.y_m + radius_m * math.sin(angle)) for angle in angles]
