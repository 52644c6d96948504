"""Skills with the ball in the mouth: dribble, aim, shoot, lob, pass, push, clear."""

import math
from abc import abstractmethod

from procs.behaviour import ballistics
from procs.behaviour.skills.skill import Drive, Scene, Status, Step
from procs.behaviour.skills.states import Exit, State, StateMachine, otherwise
from procs.behaviour.view import View
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, clamp, wrap_rad

_LOST_S = 0.3  # a ball that the light barrier misses for longer is lost
_LEAST_KICK_M_S = 1.0  # slowest kick
_DRIBBLE_M_S = 2.7  # fastest drive with the ball
_THERE_M = 0.3  # a dribble ends so near to its place
_FACE_M = 2.0  # a dribbling robot so near to its place turns to the heading that it is to have there ...
_SIDEWAYS_RAD = 1.2  # ... unless it would pull the ball back
_PULLS_RAD = 1.1  # a drive further off the mouth's direction would pull the ball, which the rules allow for 0.3 m
_AIMED_RAD = 0.1  # a robot that aims has turned to its place within this angle
_SHOT_M_S = 11.0  # speed of a shot
_SHOT_OFF_M, _SHOT_RAD = 0.15, (0.02, 0.1)  # a shot may miss its place by so much, within these limits of the angle
_ARRIVAL_M_S = 2.7  # speed at which a pass arrives
_PASS_RAD = 0.05  # error of a pass
_CLEARED_RAD = 0.15  # error of a clearance


class _WithBall(StateMachine):
    """Fails when the ball is lost."""

    def __init__(self) -> None:
        super().__init__()
        self._missing_s = 0.0

    def _watch(self, scene: Scene) -> Scene:
        self._missing_s = 0.0 if scene.holds_ball else self._missing_s + scene.duration_s
        return scene

    def _lost(self, _scene: Scene) -> bool:
        return self._missing_s > _LOST_S

    _LOST_EXIT = Exit(_lost, "lost the ball")
    _LOST = State("lost the ball", status=Status.FAILED)


class Dribble(_WithBall):
    """Turns to the place, drives there with the ball, mouth forward, and turns to the heading before it is there.

    It is there at the nearest place where the robot may stand.
    """

    def _there(self, scene: Scene) -> bool:
        return math.dist(scene.view.own.place, scene.permitted(scene.place)) < _THERE_M

    def _would_pull_the_ball(self, scene: Scene) -> bool:
        way_rad = bearing_rad(scene.view.own.place, scene.place)
        return abs(wrap_rad(way_rad - scene.view.own.heading_rad)) > _PULLS_RAD

    def _turn(self, scene: Scene) -> Step:
        return self._carry(scene, scene.view.own.place)

    def _drive(self, scene: Scene) -> Step:
        return self._carry(scene, scene.place)

    def _carry(self, scene: Scene, target: Point) -> Step:
        own = scene.view.own.place
        distance_m = math.dist(own, scene.place)
        way_rad = bearing_rad(own, scene.place)
        sideways = distance_m < _FACE_M and abs(wrap_rad(way_rad - scene.heading_rad)) < _SIDEWAYS_RAD
        heading_rad = scene.heading_rad if sideways or distance_m < 2 * _THERE_M else way_rad
        speed_m_s = min(scene.speed_m_s or _DRIBBLE_M_S, _DRIBBLE_M_S)
        return Step(Drive(target, heading_rad, speed_m_s), dribble=True)

    STATES = (
        State(
            "carry",
            exits=(_WithBall._LOST_EXIT, Exit(_there, "there")),
            inside=(State("drive", _drive), State("turn", _turn)),
            choice=(Exit(_would_pull_the_ball, "turn"), Exit(otherwise, "drive")),
        ),
        State("there", _drive, status=Status.FINAL),
        _WithBall._LOST,
    )


class Aim(_WithBall):
    """Turns with the ball to the place and waits there, ready to kick."""

    lasting = True

    def _turn(self, scene: Scene) -> Step:
        own = scene.view.own
        return Step(Drive(own.place, bearing_rad(own.place, scene.place), avoid_robots=False), dribble=True)

    def _aimed(self, scene: Scene) -> bool:
        own = scene.view.own
        return abs(wrap_rad(bearing_rad(own.place, scene.place) - own.heading_rad)) < _AIMED_RAD

    def _off(self, scene: Scene) -> bool:
        return not self._aimed(scene)

    STATES = (
        State("turn", _turn, (_WithBall._LOST_EXIT, Exit(_aimed, "wait"))),
        State("wait", _turn, (_WithBall._LOST_EXIT, Exit(_off, "turn")), status=Status.FINAL),
        _WithBall._LOST,
    )


class _Kick(_WithBall):
    """Turns with the ball until a kick sends it to the place, and kicks.

    The ball keeps the velocity of the mouth, which the robot's own drive and turn give to it; the kick adds what is
    missing to the wanted velocity.
    """

    _ONLY_DIRECTION = True  # the place gives the kick its direction; else the ball arrives there
    _TIMEOUT_S = 3.0
    _NEARLY_RAD, _SETTLES_S, _IMPATIENCE = 0.3, 0.8, 6.0
    """A robot that is nearly aimed for longer cannot turn as it should, and takes what it has got."""
    _EXACT = 0.4  # share of the tolerance in which a robot kicks although its aim still improves
    _LEAD_S = 0.03  # from the view to the kick
    _SLOWING_RAD_S = 0.5  # by which the turn is slower then than it was on the way to the view

    def __init__(self) -> None:
        super().__init__()
        self._running_s = self._nearly_s = 0.0
        self._heading_rad, self._heading_s = math.nan, 0.0  # when it was last looked at, and for how long it is so
        self._wanted_rad = self._kick_m_s = 0.0
        self._off_rad = math.nan
        self._on_target = self._asked_for = False

    @abstractmethod
    def _speed_m_s(self, scene: Scene, distance_m: float) -> float:
        """Returns the speed over the ground at which the ball leaves for a place that far away."""

    def _lift_m_s(self, _scene: Scene, _distance_m: float) -> float:
        """Returns the speed upwards at which the ball leaves for a place that far away."""
        return 0.0

    @abstractmethod
    def _tolerance_rad(self, distance_m: float) -> float:
        """Returns the largest error of the heading at that distance."""

    def _watch(self, scene: Scene) -> Scene:
        """Computes the aim of this tick, unless the kick was asked for and was not refused."""
        self._heading_s += scene.duration_s
        if self.state in ("kick", "wait for the kicker") and scene.kicked is not False:
            return scene
        self._asked_for = self.state == "kick"
        scene, own = super()._watch(scene), scene.view.own
        distance_m = math.dist(own.place, scene.place)
        speed_m_s = self._speed_m_s(scene, distance_m)
        self._running_s += scene.duration_s
        known = not math.isnan(self._heading_rad)
        turn_rad_s = wrap_rad(own.heading_rad - self._heading_rad) / self._heading_s if known else 0.0
        self._heading_rad, self._heading_s = own.heading_rad, 0.0
        slowed_rad_s = math.copysign(max(0.0, abs(turn_rad_s) - self._SLOWING_RAD_S), turn_rad_s)
        mouth_m_s = _mouth_velocity_m_s(scene.view, slowed_rad_s)
        self._wanted_rad, self._kick_m_s = self._aim(scene, speed_m_s, mouth_m_s)
        off_rad = wrap_rad(self._wanted_rad - own.heading_rad - (turn_rad_s + slowed_rad_s) / 2 * self._LEAD_S)
        self._nearly_s = self._nearly_s + scene.duration_s if abs(off_rad) < self._NEARLY_RAD else 0.0
        late_s = max(0.0, self._nearly_s - self._SETTLES_S)
        patience = 1.0 + 0.5 * self._running_s + self._IMPATIENCE * late_s  # a poor kick is better than none
        tolerance_rad = self._tolerance_rad(distance_m) * patience
        improves = 2 * abs(off_rad) > abs(self._off_rad - off_rad) and abs(off_rad) < abs(self._off_rad)
        self._off_rad = off_rad
        self._on_target = abs(off_rad) < tolerance_rad * (self._EXACT if improves else 1.0)
        return scene

    def _place_is_here(self, scene: Scene) -> bool:
        """Whether the place of a pass is no further away than the ball, so that no kick leads there."""
        here = math.dist(scene.view.own.place, scene.place) <= scene.view.bodies.held_ball_m
        return here and not self._ONLY_DIRECTION

    def _too_late(self, _scene: Scene) -> bool:
        return self._running_s > self._TIMEOUT_S

    def _ready(self, scene: Scene) -> bool:
        return self._on_target and scene.charged and scene.holds_ball and not self._asked_for

    def _kicked(self, scene: Scene) -> bool:
        return bool(scene.kicked)

    def _refused(self, scene: Scene) -> bool:
        return scene.kicked is False

    def _asked(self, _scene: Scene) -> bool:
        """Whether a tick has passed since the kick was asked for."""
        return self._asked_for

    def _aim(self, scene: Scene, speed_m_s: float, mouth_m_s: Point) -> tuple[float, float]:
        """Returns the heading at which a kick sends the ball to the place with `speed_m_s`, and the kick's speed.

        The ball moves with the mouth while the robot turns; after two rounds heading and place of the ball agree.
        """
        heading_rad, missing = bearing_rad(scene.view.own.place, scene.place), Point(0.0, 0.0)
        for _ in range(2):
            ball = ahead(scene.view.own.place, heading_rad, scene.view.bodies.held_ball_m)
            way_rad = bearing_rad(ball, scene.place)
            missing = ahead(Point(-mouth_m_s.x_m, -mouth_m_s.y_m), way_rad, speed_m_s)
            heading_rad = math.atan2(missing.y_m, missing.x_m)
        return heading_rad, max(_LEAST_KICK_M_S, math.hypot(*missing))

    def _turn(self, scene: Scene) -> Step:
        return Step(Drive(scene.view.own.place, self._wanted_rad, avoid_robots=False), dribble=True)

    def _kick(self, scene: Scene) -> Step:
        self._asked_for = True
        lift_m_s = self._lift_m_s(scene, math.dist(scene.view.own.place, scene.place))
        elevation_rad = math.atan2(lift_m_s, self._kick_m_s)
        return self._turn(scene)._replace(kick_m_s=self._kick_m_s, elevation_rad=elevation_rad)

    def _hold(self, _scene: Scene) -> Step:
        return Step(dribble=True)

    def _end(self, _scene: Scene) -> Step:
        return Step()

    _ANSWERED = (Exit(_kicked, "kicked"), Exit(_refused, "turn"))
    STATES = (
        State(
            "turn",
            _turn,
            (
                _WithBall._LOST_EXIT,
                Exit(_place_is_here, "the place is at the robot itself"),
                Exit(_too_late, "could not aim in time"),
                Exit(_ready, "kick"),
            ),
        ),
        State("kick", _kick, (Exit(_asked, "wait for the kicker"),)),
        State("wait for the kicker", _hold, _ANSWERED),
        State("kicked", _end, status=Status.FINAL),
        State("the place is at the robot itself", status=Status.FAILED),
        State("could not aim in time", status=Status.FAILED),
        _WithBall._LOST,
    )


class Shoot(_Kick):
    """Kicks hard at the place."""

    def _speed_m_s(self, _scene: Scene, _distance_m: float) -> float:
        return _SHOT_M_S

    def _tolerance_rad(self, distance_m: float) -> float:
        return clamp(_SHOT_OFF_M / max(distance_m, 0.1), *_SHOT_RAD)


class Clear(Shoot):
    """Kicks hard, roughly towards the place and as soon as possible: the ball only has to go."""

    _EXACT = 1.0

    def _tolerance_rad(self, _distance_m: float) -> float:
        return _CLEARED_RAD


class Lob(Shoot):
    """Kicks over robots at a place on the goal line, under the bar."""

    def _speed_m_s(self, scene: Scene, distance_m: float) -> float:
        return _lob(scene, distance_m).speed_m_s

    def _lift_m_s(self, scene: Scene, distance_m: float) -> float:
        return _lob(scene, distance_m).lift_m_s


class Pass(_Kick):
    """Kicks so that the ball arrives at the place at a speed that a robot can take."""

    _ONLY_DIRECTION = False

    def _speed_m_s(self, scene: Scene, distance_m: float) -> float:
        bodies = scene.view.bodies
        rolls_m = max(0.0, distance_m - 2 * bodies.held_ball_m)  # from mouth to mouth
        return ballistics.kick_speed_m_s(rolls_m, scene.speed_m_s or _ARRIVAL_M_S, bodies)

    def _tolerance_rad(self, _distance_m: float) -> float:
        return _PASS_RAD


class Push(Pass):
    """Sets the ball free, slowly, for the robot that kicks it."""


def _lob(scene: Scene, distance_m: float) -> ballistics.Lob:
    own, bodies, way_rad = scene.view.own, scene.view.bodies, bearing_rad(scene.view.own.place, scene.place)
    carried_m_s = own.velocity_m_s.x_m * math.cos(way_rad) + own.velocity_m_s.y_m * math.sin(way_rad)
    return ballistics.lob(distance_m - bodies.held_ball_m, bodies, max(0.0, carried_m_s))


def _mouth_velocity_m_s(view: View, turn_rad_s: float) -> Point:
    """Returns the velocity of the ball in the mouth of the own robot, which drives and turns."""
    own, turning_m_s = view.own, turn_rad_s * view.bodies.held_ball_m
    return Point(
        own.velocity_m_s.x_m - turning_m_s * math.sin(own.heading_rad),
        own.velocity_m_s.y_m + turning_m_s * math.cos(own.heading_rad),
    )
