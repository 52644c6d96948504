"""The skill that searches: first for the own place on the field, then for the ball."""

import math

from procs.behaviour.skills.skill import Blind, Drive, Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine
from procs.behaviour.view import View
from procs.model.field import Field, Point
from procs.model.geometry import bearing_rad

_STAND_S = 1.5  # a standing camera sees best, and most robots find their place at once
_TURN_RAD_S, _TURN_S = 0.8, 4.0  # of the turn on the spot: half a circle
_AHEAD_M_S, _AHEAD_M = 0.5, 1.0  # of the way ahead
_BESIDE_M = 0.15  # room beside a robot that drives ahead
_STRIP_M = 1.0  # a line ahead, at most so far to the side, shows that the field goes on
_THERE_M = 0.3  # a robot this near to a place looks from there
_WAY_S = 10.0  # across the field; a robot that is not there by then looks from where it is
_LOOK_S = 0.6  # from each place
_VANTAGE = ((-0.55, 0.45), (-0.55, -0.45), (0.0, 0.55), (0.0, -0.55), (0.55, 0.45), (0.55, -0.45))
"""Vantage points in the attack frame, as shares of half the length and half the width of the field."""
_IDLE = ("goalkeeper", "absent")


class Search(StateMachine):
    """Finds the own place, then the ball.

    A robot that does not know its place stands, turns on the spot, and drives a short way where it sees free ground. A
    robot that knows it goes to the place of the command, then to its share of the vantage points, and looks from each,
    or from the nearest place that it reaches.
    """

    def __init__(self) -> None:
        super().__init__()
        self._timed, self._passed_s = "", 0.0
        self._looks = 0  # number of places from which the robot has looked

    def _watch(self, scene: Scene) -> Scene:
        self._passed_s = self._in_state_s() + scene.duration_s
        return scene

    def _in_state_s(self) -> float:
        """Returns for how long the present state has lasted."""
        if self.state != self._timed:
            self._timed, self._passed_s = self.state, 0.0
        return self._passed_s

    def _localized(self, scene: Scene) -> bool:
        return scene.view.localized

    def _lost(self, scene: Scene) -> bool:
        return not scene.view.localized

    def _ball_known(self, scene: Scene) -> bool:
        return scene.view.ball.known

    def _stood_in_vain(self, _scene: Scene) -> bool:
        return self._in_state_s() >= _STAND_S

    def _turned_in_vain(self, scene: Scene) -> bool:
        return self._in_state_s() >= _TURN_S and way_is_free(scene, _AHEAD_M)

    def _far_enough(self, _scene: Scene) -> bool:
        return self._in_state_s() * _AHEAD_M_S >= _AHEAD_M

    def _way_blocked(self, scene: Scene) -> bool:
        return not way_is_free(scene, _AHEAD_M - self._in_state_s() * _AHEAD_M_S)

    def _there(self, scene: Scene) -> bool:
        return math.dist(scene.view.own.place, scene.permitted(self._target(scene))) < _THERE_M

    def _went_in_vain(self, _scene: Scene) -> bool:
        return self._in_state_s() >= _WAY_S

    def _looked(self, _scene: Scene) -> bool:
        """Whether the robot has looked long enough; its next place is another one then."""
        looked = self._in_state_s() >= _LOOK_S
        self._looks += looked
        return looked

    def _target(self, scene: Scene) -> Point:
        places = vantage_points(scene.view, scene.field)
        return places[(self._looks - 1) % len(places)] if self._looks else scene.place

    def _stand(self, _scene: Scene) -> Step:
        return Step()

    def _turn(self, _scene: Scene) -> Step:
        return Step(blind=Blind(0.0, _TURN_RAD_S))

    def _ahead(self, _scene: Scene) -> Step:
        return Step(blind=Blind(_AHEAD_M_S, 0.0))

    def _go(self, scene: Scene) -> Step:
        target = self._target(scene)
        return Step(Drive(target, bearing_rad(target, Point(0.0, 0.0)), scene.speed_m_s))

    def _found(self, scene: Scene) -> Step:
        return Step(dribble=scene.holds_ball)

    STATES = (
        State(
            "find the own place",
            exits=(Exit(_localized, "look for the ball"),),
            inside=(
                State("stand", _stand, (Exit(_stood_in_vain, "turn"),)),
                State("turn", _turn, (Exit(_turned_in_vain, "drive ahead"),)),
                State("drive ahead", _ahead, (Exit(_far_enough, "turn"), Exit(_way_blocked, "turn"))),
            ),
        ),
        State(
            "look for the ball",
            exits=(Exit(_lost, "find the own place"), Exit(_ball_known, "found")),
            inside=(
                State("go", _go, (Exit(_there, "look"), Exit(_went_in_vain, "look"))),
                State("look", _go, (Exit(_looked, "go"),)),
            ),
        ),
        State("found", _found, status=Status.FINAL),
    )


def way_is_free(scene: Scene, way_m: float) -> bool:
    """Returns whether a robot that does not know its place may drive `way_m` ahead.

    It sees no obstacle on the way, and a line beyond: nothing else tells it that no wall is there. At a set piece it
    would have to keep a distance that it does not know, so it does not drive.
    """
    sight, game = scene.sight, scene.game
    if sight is None or not (game.free_play or game.paused):
        return False
    robot_m = scene.view.bodies.robot_radius_m
    reach_m, beside_m = way_m + robot_m, robot_m + _BESIDE_M
    for obstacle in sight.obstacles:
        x_m, y_m = obstacle.place
        if x_m > 0.0 and x_m - obstacle.radius_m < reach_m and abs(y_m) - obstacle.radius_m < beside_m:
            return False
    return any(line.x_m > reach_m and abs(line.y_m) < _STRIP_M for line in sight.lines)


def vantage_points(view: View, field: Field) -> list[Point]:
    """Returns the robot's share of the points between the goal areas, in the attack frame.

    The field players that know their places divide the points among them by their numbers, from the own goal on.
    """
    searching = [view.own, *(mate for mate in view.mates if mate.role not in _IDLE)]
    searching.sort(key=lambda robot: (robot.number, robot.name))
    rank, n_robots, n_points = searching.index(view.own), len(searching), len(_VANTAGE)
    first, end = rank * n_points // n_robots, (rank + 1) * n_points // n_robots
    shares = _VANTAGE[first : max(end, first + 1)]
    return [Point(x * field.half_length_m, y * field.half_width_m) for x, y in shares]
