"""Skills with the ball in the mouth: dribble, shoot, pass."""

import math
from abc import abstractmethod

from procs.behaviour import ballistics
from procs.behaviour.skills.skill import Drive, Scene, Skill, Status, Step, failed
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, clamp, wrap_rad

_LOST_S = 0.3  # the light barrier may miss the ball so long before it counts as lost
_DRIBBLE_M_S = 2.7
_THERE_M = 0.3
_SHOT_M_S = 11.0
_ARRIVAL_M_S = 2.2


class _WithBall(Skill):
    """Fails when the ball is lost."""

    def __init__(self) -> None:
        self._missing_s = 0.0

    def step(self, scene: Scene) -> Step:
        self._missing_s = 0.0 if scene.holds_ball else self._missing_s + scene.duration_s
        if self._missing_s > _LOST_S:
            return failed("lost the ball")
        return self._play(scene)

    @abstractmethod
    def _play(self, scene: Scene) -> Step:
        """What to do with the ball."""


class Dribble(_WithBall):
    """Drives with the ball to the place, mouth forward, and turns to the heading there."""

    def _play(self, scene: Scene) -> Step:
        own = scene.view.own.place
        distance_m = math.dist(own, scene.place)
        heading_rad = bearing_rad(own, scene.place) if distance_m > 2 * _THERE_M else scene.heading_rad
        speed_m_s = min(scene.speed_m_s or _DRIBBLE_M_S, _DRIBBLE_M_S)
        status = Status.FINAL if distance_m < _THERE_M else Status.RUNNING
        return Step(Drive(scene.place, heading_rad, speed_m_s), dribble=True, status=status)


class _Kick(_WithBall):
    """Turns with the ball until it points at the place, allows for its own motion, and kicks."""

    _TIMEOUT_S = 3.0
    _LEAD_S = 0.04  # from the view to the kick
    _WAIT_S = 0.15  # for the kicker's answer, before it is asked again
    _BRAKE_M_S2 = 3.0

    def __init__(self) -> None:
        super().__init__()
        self._running_s = 0.0
        self._kick = 0
        self._asked_s = 0.0
        self._stand: Point | None = None
        self._heading_rad = math.nan

    def step(self, scene: Scene) -> Step:
        if self._kick:
            return self._await(scene)
        return super().step(scene)

    @abstractmethod
    def _speed_m_s(self, distance_m: float) -> float:
        """Of the ball, to get so far."""

    @abstractmethod
    def _tolerance_rad(self, distance_m: float) -> float:
        """How well the robot has to point there."""

    def _await(self, scene: Scene) -> Step:
        self._asked_s += scene.duration_s
        if scene.kicks_done >= self._kick:
            return Step(status=Status.FINAL)
        if self._asked_s > self._WAIT_S:
            self._kick, self._asked_s = 0, 0.0
        return Step(dribble=True)

    def _play(self, scene: Scene) -> Step:
        own = scene.view.own
        distance_m = math.dist(own.place, scene.place)
        speed_m_s = self._speed_m_s(distance_m)
        self._running_s += scene.duration_s
        if self._running_s > self._TIMEOUT_S:
            return failed("could not aim in time")
        way_rad = bearing_rad(own.place, scene.place)
        aside_m_s = own.velocity_m_s.y_m * math.cos(way_rad) - own.velocity_m_s.x_m * math.sin(way_rad)
        wanted_rad = wrap_rad(way_rad - math.asin(clamp(aside_m_s / speed_m_s, -0.5, 0.5)))
        turn_rad_s = wrap_rad(own.heading_rad - self._heading_rad) / scene.duration_s if self._running_s > 0.06 else 0.0
        self._heading_rad = own.heading_rad
        off_rad = wrap_rad(wanted_rad - own.heading_rad - turn_rad_s * self._LEAD_S)
        patience = 1.0 + self._running_s  # better a poor kick than none
        if abs(off_rad) < self._tolerance_rad(distance_m) * patience and scene.charged and scene.holds_ball:
            self._kick = scene.kicks_asked + 1
            return Step(self._turn(scene, wanted_rad), dribble=True, kick_m_s=speed_m_s)
        return Step(self._turn(scene, wanted_rad), dribble=True)

    def _turn(self, scene: Scene, heading_rad: float) -> Drive:
        if self._stand is None:
            own = scene.view.own
            speed_m_s = math.hypot(*own.velocity_m_s)
            course_rad = math.atan2(own.velocity_m_s.y_m, own.velocity_m_s.x_m)
            self._stand = ahead(own.place, course_rad, speed_m_s**2 / (2 * self._BRAKE_M_S2))
        return Drive(self._stand, heading_rad, avoid_robots=False)


class Shoot(_Kick):
    """Kicks hard at the place."""

    def _speed_m_s(self, _distance_m: float) -> float:
        return _SHOT_M_S

    def _tolerance_rad(self, distance_m: float) -> float:
        return clamp(0.15 / max(distance_m, 0.1), 0.02, 0.1)


class Pass(_Kick):
    """Kicks so that the ball arrives at the place at a speed that a robot can take."""

    def _speed_m_s(self, distance_m: float) -> float:
        return ballistics.kick_speed_m_s(distance_m, _ARRIVAL_M_S)

    def _tolerance_rad(self, _distance_m: float) -> float:
        return 0.05
