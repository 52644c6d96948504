"""The goalkeeper's skills: come out towards the ball, save shots, and dive for those that it reaches only at speed."""

import math
from typing import NamedTuple

from procs.behaviour import ballistics
from procs.behaviour.skills.skill import Drive, Scene, Step
from procs.behaviour.skills.states import Exit, State, StateMachine, otherwise
from procs.model.field import Field, Point
from procs.model.geometry import ahead, bearing_rad, clamp

BEFORE_LINE_M = 0.45
"""The keeper's middle is so far before the goal line, or further out."""
_ON_GUARD_M = 1.5  # a keeper further away drives around robots on its way home
_SHOT_M_S, _LOOK_AHEAD_S = 0.8, 3.0  # a ball that comes faster, and would be there so soon, is a shot
_OFF_POST_M = 0.15  # a keeper on its line stays so far inside the posts
_COVERED, _LEAN = 0.75, 0.08  # shares: of its reach while no shot comes, and of the ball's offset that it moves aside
_LEAST_DEPTH_M = 0.3  # a ball nearer to the goal line counts as so far before it
_TURNED_RAD = 1.3  # the keeper's heading differs from straight ahead by no more
_BEHIND_RAD = 2.2  # a ball further off straight ahead is behind the keeper, on either side
_WIDE_M = 0.6  # a shot that passes the post further away is let go
_WIDE_S = 2.0  # a ball that crosses the goal line so soon, beside the goal, is let go
_COMES_OUT_M = 8.0  # a ball nearer to the goal draws the keeper out ...
_OUT_1_M = 0.45  # ... by so much for each metre
_FRONT = 1.6  # cosine of the ball's direction from the goal by this is the share for balls from the side
_STEP_S = 0.05  # from one place on the ball's way that is looked at to the next
_CAUGHT_M = 0.05  # a ball whose way crosses the keeper's body so deep hits it
_CHANGE_M_S2, _SPEED_M_S = 2.8, 2.8  # of the keeper that does not stop at the ball's way
_HOPELESS_S = 0.2  # by which a dive may be late: the ball's velocity is known roughly
_BEYOND_M = 0.6  # a dive is aimed so far beyond the ball's way, and turns back after it


class Save(NamedTuple):
    """Place on the way of a shot where the keeper stops the ball."""

    place: Point
    spare_s: float
    """Time that is left there if the keeper drives to it without stopping; negative if it comes late."""
    stops: bool
    """The keeper can also stop there in time."""


class KeepLine(StateMachine):
    """Moves along a line before the goal: to the path of a shot, else to the place that covers the goal best."""

    lasting = True

    def _ball_unknown(self, scene: Scene) -> bool:
        return not scene.view.ball.known

    def _shot(self, scene: Scene) -> bool:
        return crossing_m(scene) is not None

    def _wait_in_the_middle(self, scene: Scene) -> Step:
        return self._stand(scene, Point(_line_x_m(scene.field), 0.0))

    def _cover(self, scene: Scene) -> Step:
        field, ball = scene.field, scene.view.ball
        reach_m = _reach_m(field)
        depth_m = max(ball.place.x_m + field.half_length_m, _LEAST_DEPTH_M)
        cover_m = ball.place.y_m * BEFORE_LINE_M / depth_m
        y_m = clamp(cover_m + _LEAN * ball.place.y_m, -reach_m * _COVERED, reach_m * _COVERED)
        return self._stand(scene, Point(_line_x_m(field), y_m))

    def _block(self, scene: Scene) -> Step:
        reach_m = _reach_m(scene.field)
        y_m = clamp(crossing_m(scene) or 0.0, -reach_m, reach_m)
        return self._stop_shot(scene, Point(_line_x_m(scene.field), y_m))

    def _stand(self, scene: Scene, place: Point) -> Step:
        heading_rad = bearing_rad(place, scene.view.ball.place) if scene.view.ball.known else 0.0
        if abs(heading_rad) > _BEHIND_RAD:  # the side of such a ball changes with its noise
            heading_rad = math.copysign(_TURNED_RAD, scene.view.own.heading_rad)
        heading_rad = clamp(heading_rad, -_TURNED_RAD, _TURNED_RAD)
        drive = Drive(place, heading_rad, scene.speed_m_s, avoid_ball=_is_beyond_ball(scene))
        return Step(drive, dribble=scene.holds_ball)

    def _stop_shot(self, scene: Scene, place: Point, end_speed_m_s: float = 0.0) -> Step:
        """Drives straight to the way of a shot, even past robots; a keeper far from its goal drives around them."""
        step, away = self._stand(scene, place), math.dist(place, scene.view.own.place) > _ON_GUARD_M
        assert step.drive
        return step._replace(drive=step.drive._replace(end_speed_m_s=end_speed_m_s, avoid_robots=away))

    STATES = (
        State(
            "keep the line",
            inside=(
                State("cover", _cover),
                State("block", _block),
                State("wait in the middle", _wait_in_the_middle),
            ),
            choice=(
                Exit(_ball_unknown, "wait in the middle"),
                Exit(_shot, "block"),
                Exit(otherwise, "cover"),
            ),
        ),
    )


class KeepGoal(KeepLine):
    """Comes out towards the ball, at most to the x of the place; meets shots where it is soonest, or dives."""

    def __init__(self) -> None:
        super().__init__()
        self._save: Save | None = None

    def _watch(self, scene: Scene) -> Scene:
        crosses_m = crossing_m(scene) if scene.view.ball.known else None
        beside_m = scene.field.goal_width_m / 2 + scene.view.bodies.ball_radius_m
        on_goal = crosses_m is not None and abs(crosses_m) < beside_m
        self._save = best_save(scene) if on_goal else None
        return scene

    def _goes_wide(self, scene: Scene) -> bool:
        """Whether the ball crosses the goal line soon, beside the goal; also a slow ball may roll into it."""
        ball = scene.view.ball
        ahead_m = ball.place.x_m + scene.field.half_length_m
        if not 0.0 < ahead_m < -ball.velocity_m_s.x_m * _WIDE_S:
            return False
        y_m = ball.place.y_m - ball.velocity_m_s.y_m * ahead_m / ball.velocity_m_s.x_m
        return abs(y_m) >= scene.field.goal_width_m / 2 + scene.view.bodies.ball_radius_m

    def _let_it_go(self, scene: Scene) -> Step:
        return self._stand(scene, scene.view.own.place)

    def _reaches(self, _scene: Scene) -> bool:
        return self._save is not None and self._save.stops

    def _reaches_at_speed(self, _scene: Scene) -> bool:
        return self._save is not None and self._save.spare_s > -_HOPELESS_S

    def _come_out(self, scene: Scene) -> Step:
        """Covers both corners from the line between ball and goal: the nearer the ball, the further out.

        A keeper beyond the ball goes back before it.
        """
        field, ball = scene.field, scene.view.ball.place
        goal = field.goal_centre(-1.0)
        furthest_m = max(BEFORE_LINE_M, scene.place.x_m + field.half_length_m)
        way_rad = bearing_rad(goal, ball)
        share = min(1.0, _FRONT * max(0.0, math.cos(way_rad)))
        if _is_beyond_ball(scene):
            furthest_m = max(BEFORE_LINE_M, min(furthest_m, math.dist(goal, ball) - scene.view.bodies.beside_m))
        out_m = clamp(share * _OUT_1_M * (_COMES_OUT_M - math.dist(goal, ball)), BEFORE_LINE_M, furthest_m)
        if out_m <= BEFORE_LINE_M or ball.x_m < -field.half_length_m + BEFORE_LINE_M:
            return self._cover(scene)
        place = ahead(goal, way_rad, out_m)
        return self._stand(scene, Point(max(place.x_m, _line_x_m(field)), place.y_m))

    def _meet(self, scene: Scene) -> Step:
        assert self._save
        return self._stop_shot(scene, self._save.place)

    def _dive(self, scene: Scene) -> Step:
        assert self._save
        way_rad = bearing_rad(scene.view.own.place, self._save.place)
        step = self._stop_shot(scene, ahead(self._save.place, way_rad, _BEYOND_M), _SPEED_M_S)
        assert step.drive
        return step._replace(drive=step.drive._replace(heading_rad=scene.view.own.heading_rad, avoid_robots=False))

    STATES = (
        State(
            "guard",
            inside=(
                State("come out", _come_out),
                State("let it go", _let_it_go),
                State("wait in the middle", KeepLine._wait_in_the_middle),
                State(
                    "save",
                    inside=(State("meet", _meet), State("dive", _dive), State("block", KeepLine._block)),
                    choice=(
                        Exit(_reaches, "meet"),
                        Exit(_reaches_at_speed, "dive"),
                        Exit(otherwise, "block"),
                    ),
                ),
            ),
            choice=(
                Exit(KeepLine._ball_unknown, "wait in the middle"),
                Exit(KeepLine._shot, "save"),
                Exit(_goes_wide, "let it go"),
                Exit(otherwise, "come out"),
            ),
        ),
    )


def crossing_m(scene: Scene) -> float | None:
    """Returns the y at which a shot crosses the keeper's line; None if the ball does not come, or goes wide."""
    ball = scene.view.ball
    ahead_m = ball.place.x_m - _line_x_m(scene.field)
    if not (ball.velocity_m_s.x_m < -_SHOT_M_S and 0 < ahead_m < -ball.velocity_m_s.x_m * _LOOK_AHEAD_S):
        return None
    y_m = ball.place.y_m - ball.velocity_m_s.y_m * ahead_m / ball.velocity_m_s.x_m
    return y_m if abs(y_m) < scene.field.goal_width_m / 2 + _WIDE_M else None


def best_save(scene: Scene) -> Save | None:
    """Returns the place on the ball's way where the keeper has the most time to spare; None if the ball stops before.

    Places behind the keeper's line are too late, and places beyond `_ON_GUARD_M` too far out.
    """
    own, best, caught_m = scene.view.own, None, scene.view.bodies.robot_radius_m - _CAUGHT_M
    start = ballistics.carried(own.place, own.velocity_m_s)
    for step in range(1, round(_LOOK_AHEAD_S / _STEP_S)):
        time_s = step * _STEP_S
        place = ballistics.ball_after(scene.view.ball, time_s, scene.view.bodies)
        out_m = place.x_m + scene.field.half_length_m
        if out_m < BEFORE_LINE_M - _STEP_S * _SPEED_M_S:
            break
        if out_m > BEFORE_LINE_M + _ON_GUARD_M:
            continue
        away_m = max(0.0, math.dist(start, place) - caught_m)
        spare_s = time_s - _dive_s(away_m)
        if best is None or spare_s > best.spare_s:
            best = Save(place, spare_s, stops=ballistics.reach_s(away_m) <= time_s)
    return best


def _is_beyond_ball(scene: Scene) -> bool:
    """Returns whether the ball lies nearer to the own goal than the keeper, whose straight way would push it in."""
    return scene.view.ball.known and scene.view.ball_is_nearer_to(scene.field.goal_centre(-1.0))


def _dive_s(distance_m: float) -> float:
    """Returns the time in which the keeper gets so far without stopping there."""
    speeding_m = _SPEED_M_S**2 / (2 * _CHANGE_M_S2)
    if distance_m < speeding_m:
        return math.sqrt(2 * distance_m / _CHANGE_M_S2)
    return _SPEED_M_S / _CHANGE_M_S2 + (distance_m - speeding_m) / _SPEED_M_S


def _reach_m(field: Field) -> float:
    """Returns how far from the middle of the goal a keeper on its line stands at most."""
    return field.goal_width_m / 2 - _OFF_POST_M


def _line_x_m(field: Field) -> float:
    return -field.half_length_m + BEFORE_LINE_M
