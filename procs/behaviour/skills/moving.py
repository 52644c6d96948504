"""Skills without the ball: stop, goto, mark, block."""

import math
from abc import abstractmethod

from procs.behaviour import formation
from procs.behaviour.game import Whose
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine, otherwise
from procs.model.field import Point
from procs.model.game_states import State as GameState
from procs.model.geometry import ahead, bearing_rad, wrap_rad

_NEAR_M, _NEAR_RAD = 0.1, 0.1  # from place and heading a robot is there
_MARK_M = 0.9  # from the marked opponent
_BLOCK_M, _LEAD_S = 1.0, 0.3  # from a dribbled ball, where it will be so much later
_LAID_M = 1.0  # the ball so near to the place is what is blocked


class Stop(StateMachine):
    """Stands still."""

    lasting = True

    def _stand(self, _scene: Scene) -> Step:
        return Step()

    STATES = (State("stand", _stand, status=Status.FINAL),)


class _Place(StateMachine):
    """Drives to a place and a heading, around the ball, and stays there.

    It is there at the nearest place where the robot may stand.
    """

    lasting = True

    @abstractmethod
    def _target(self, scene: Scene) -> tuple[Point, float]:
        """Returns place and heading."""

    def _drive(self, scene: Scene) -> Step:
        return Step(Drive(*self._target(scene), scene.speed_m_s, avoid_ball=True))

    def _there(self, scene: Scene) -> bool:
        own, (place, heading_rad) = scene.view.own, self._target(scene)
        turned_rad = abs(wrap_rad(own.heading_rad - heading_rad))
        return math.dist(own.place, scene.permitted(place)) < _NEAR_M and turned_rad < _NEAR_RAD

    def _away(self, scene: Scene) -> bool:
        return not self._there(scene)

    STATES = (
        State("drive", _drive, (Exit(_there, "stay"),)),
        State("stay", _drive, (Exit(_away, "drive"),), status=Status.FINAL),
    )


class Goto(_Place):
    """Drives to the place and heading, around the ball, and stays there."""

    def _target(self, scene: Scene) -> tuple[Point, float]:
        return scene.place, scene.heading_rad


class Mark(_Place):
    """Stands between the opponent at the place and the own goal, facing the ball."""

    def _target(self, scene: Scene) -> tuple[Point, float]:
        goal = scene.field.goal_centre(-1.0)
        place = ahead(scene.place, bearing_rad(scene.place, goal), min(_MARK_M, math.dist(scene.place, goal)))
        return place, bearing_rad(place, scene.view.ball.place)


class Block(StateMachine):
    """Stands between the ball and the own goal, facing the ball.

    At a set piece of the other team, as which a dropped ball counts, it keeps the distance of the rules; in play it
    stands close before the ball, and so before the rival that dribbles it. What is blocked is the ball if it is near
    the place, and otherwise the place.
    """

    lasting = True

    def __init__(self) -> None:
        super().__init__()
        self._target = Drive(Point(0.0, 0.0), 0.0)

    def _watch(self, scene: Scene) -> Scene:
        self._target = (self._at_distance if self._their_set_piece(scene) else self._close)(scene)
        return scene

    def _their_set_piece(self, scene: Scene) -> bool:
        game = scene.game
        theirs = game.whose is Whose.THEIRS or game.state is GameState.DROP_BALL
        return theirs and not game.free_play and not game.paused

    def _there(self, scene: Scene) -> bool:
        own, target = scene.view.own, self._target
        turned_rad = abs(wrap_rad(own.heading_rad - target.heading_rad))
        return math.dist(own.place, target.place) < _NEAR_M and turned_rad < _NEAR_RAD

    def _away(self, scene: Scene) -> bool:
        return not self._there(scene)

    def _at_distance(self, scene: Scene) -> Drive:
        """Returns the drive to the nearest place that the rules allow, on a way that keeps the distance."""
        view, field, game = scene.view.without(scene.game.sent_off), scene.field, scene.game
        if math.dist(scene.place, game.spot) < _LAID_M:
            game = game._replace(spot=scene.place)
        wanted = formation.first_opponent_place(game, field, view.bodies)
        place = formation.next_step(view.own.place, wanted, game, field, view.others, view.bodies)
        facing = view.ball.place if view.ball.known else game.spot
        return Drive(place, bearing_rad(place, facing), scene.speed_m_s, avoid_ball=True)

    def _close(self, scene: Scene) -> Drive:
        ball, goal, blocked = scene.view.ball, scene.field.goal_centre(-1.0), scene.place
        if ball.known and math.dist(ball.place, blocked) < _LAID_M:
            blocked = ahead(
                ball.place, math.atan2(ball.velocity_m_s.y_m, ball.velocity_m_s.x_m), _LEAD_S * ball.speed_m_s
            )
        place = ahead(blocked, bearing_rad(blocked, goal), min(_BLOCK_M, math.dist(blocked, goal)))
        return Drive(place, bearing_rad(place, blocked), scene.speed_m_s, avoid_ball=True)

    def _drive(self, _scene: Scene) -> Step:
        return Step(self._target)

    STATES = (
        State(
            "get in the way",
            exits=(Exit(_there, "stay in the way"),),
            inside=(State("keep the distance", _drive), State("come close", _drive)),
            choice=(Exit(_their_set_piece, "keep the distance"), Exit(otherwise, "come close")),
        ),
        State("stay in the way", _drive, (Exit(_away, "get in the way"),), status=Status.FINAL),
    )
