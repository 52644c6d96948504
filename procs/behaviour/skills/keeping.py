"""The goalkeeper's skill: stay between ball and goal, and be where a shot will cross the line."""

import math

from procs.behaviour.skills.skill import Drive, Scene, Skill, Status, Step
from procs.model.field import Point
from procs.model.geometry import bearing_rad, clamp

_BEFORE_LINE_M = 0.45
_ON_GUARD_M = 1.5  # a keeper further away drives around robots on its way home
_SHOT_M_S = 0.8
_LOOK_AHEAD_S = 3.0
_WIDE_M = 0.6  # a shot that passes the post further away is let go


class KeepGoal(Skill):
    """Moves along a line before the goal: to the path of a shot, else to the place that covers the goal best."""

    lasting = True

    def step(self, scene: Scene) -> Step:
        place = self._place(scene)
        heading_rad = bearing_rad(place, scene.view.ball.place) if scene.view.ball.known else 0.0
        away = math.dist(place, scene.view.own.place) > _ON_GUARD_M
        drive = Drive(place, clamp(heading_rad, -1.3, 1.3), scene.speed_m_s, avoid_robots=away)
        return Step(drive, dribble=scene.holds_ball, status=Status.RUNNING)

    def _place(self, scene: Scene) -> Point:
        field, ball = scene.field, scene.view.ball
        line_x_m = -field.half_length_m + _BEFORE_LINE_M
        reach_m = field.goal_width_m / 2 - 0.15
        if not ball.known:
            return Point(line_x_m, 0.0)
        ahead_m = ball.place.x_m - line_x_m
        if ball.velocity_m_s.x_m < -_SHOT_M_S and 0 < ahead_m < -ball.velocity_m_s.x_m * _LOOK_AHEAD_S:
            crossing_m = ball.place.y_m - ball.velocity_m_s.y_m * ahead_m / ball.velocity_m_s.x_m
            if abs(crossing_m) < field.goal_width_m / 2 + _WIDE_M:
                return Point(line_x_m, clamp(crossing_m, -reach_m, reach_m))
        depth_m = max(ball.place.x_m + field.half_length_m, 0.3)
        cover_m = ball.place.y_m * _BEFORE_LINE_M / depth_m
        return Point(line_x_m, clamp(cover_m + 0.08 * ball.place.y_m, -reach_m * 0.75, reach_m * 0.75))
