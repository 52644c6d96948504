"""A robot's view of the match in the attack frame: the world turned so that the own team always attacks +x.

For cyan this is the world frame; for magenta it is turned by half a turn. All decisions about the game use it, so
both teams run the same code and play alike.
"""

import math
from collections.abc import Container, Iterable, Mapping
from typing import NamedTuple

from lcmtypes.soccer import ball_estimate_t, mate_estimate_t, pass_agreement_t, robot_estimate_t, world_model_t
from procs.behaviour.bodies import USUAL, Bodies
from procs.model.field import Point
from procs.model.geometry import plausible, wrap_rad
from procs.model.robot import PLAYERS, Player, number_of_mate, number_of_player

Estimate = mate_estimate_t | robot_estimate_t
"""Another robot in the world model."""


class Frame(NamedTuple):
    """Turns points and directions between world frame and attack frame; both ways are the same."""

    sign: float
    """1.0: the team attacks +x and nothing changes; -1.0: half a turn."""

    def point(self, x_m: float, y_m: float) -> Point:
        """Returns a point, or a velocity, in the other frame."""
        return Point(self.sign * x_m + 0.0, self.sign * y_m + 0.0)  # no -0.0, whose sign would be a side

    def heading_rad(self, heading_rad: float) -> float:
        """Returns a direction in the other frame; one that is no angle stays, for the skiller to refuse."""
        same = self.sign > 0 or not math.isfinite(heading_rad)
        return heading_rad if same else wrap_rad(heading_rad + math.pi)


class Agreement(NamedTuple):
    """Agreement of a robot with its team about a pass."""

    receiver: str = ""
    """Mate to which it will pass, or has just passed."""
    place: Point = Point(0.0, 0.0)
    """Place of that pass."""
    passer: str = ""
    """Mate whose announced pass it accepts."""


_SILENT = Agreement()


class Robot(NamedTuple):
    """A robot as the own robot knows it; heading and role only for team mates and itself."""

    name: str
    place: Point
    heading_rad: float = 0.0
    velocity_m_s: Point = Point(0.0, 0.0)
    role: str = ""
    agreement: Agreement = _SILENT
    number: int = 0
    """On its back, for team mates and itself."""


class Ball(NamedTuple):
    """The ball as the team knows it; `known` is false without a recent sighting."""

    known: bool
    place: Point = Point(0.0, 0.0)
    velocity_m_s: Point = Point(0.0, 0.0)

    @property
    def speed_m_s(self) -> float:
        """Speed over the ground."""
        return math.hypot(*self.velocity_m_s)

    def is_near(self, robots: Iterable[Robot], within_m: float) -> bool:
        """Returns whether one of the robots is nearer to the ball than `within_m`."""
        return any(math.dist(robot.place, self.place) < within_m for robot in robots)


class View(NamedTuple):
    """Beliefs of a robot about the match."""

    localized: bool
    own: Robot
    ball: Ball
    mates: tuple[Robot, ...] = ()
    opponents: tuple[Robot, ...] = ()
    silent_mates: tuple[Robot, ...] = ()
    """Mates that are seen, but do not tell their names and places."""
    bodies: Bodies = USUAL
    """Sizes of the robots and the ball, and the ball's friction."""

    @property
    def others(self) -> tuple[Robot, ...]:
        """All robots but the own one."""
        return (*self.mates, *self.opponents, *self.silent_mates)

    def ball_is_nearer_to(self, place: Point) -> bool:
        """Returns whether the ball is nearer to a place than the robot is."""
        return math.dist(place, self.ball.place) < math.dist(place, self.own.place)

    def is_at_ball(self, robots: Iterable[Robot], within_m: float) -> bool:
        """Returns whether the ball is nearer than `within_m` to the body of one of the robots."""
        return self.ball.is_near(robots, self.bodies.beside_m + within_m)

    def without(self, robots: Container[str]) -> "View":
        """Returns the view without mates that take no part in the game."""
        return self._replace(mates=tuple(mate for mate in self.mates if mate.name not in robots))


def view_of(
    model: world_model_t,
    name: str,
    role: str,
    frame: Frame,
    mate_timeout_s: float = 2.0,
    agreement: Agreement = _SILENT,
    players: Mapping[str, Player] = PLAYERS,
    bodies: Bodies = USUAL,
) -> View:
    """Turns the world model into the attack frame; `role` and `agreement` are the robot's own words.

    Mates that were silent for the time-out are left out, and so are robots with implausible values.
    """
    here = plausible(model.x_m, model.y_m, model.heading_rad, model.vx_m_s, model.vy_m_s)
    own = Robot(name, Point(0.0, 0.0), role=role, agreement=agreement, number=number_of_player(name, players))
    if here:
        place, velocity_m_s = frame.point(model.x_m, model.y_m), frame.point(model.vx_m_s, model.vy_m_s)
        own = own._replace(place=place, heading_rad=frame.heading_rad(model.heading_rad), velocity_m_s=velocity_m_s)
    return View(
        here and model.localized,
        own,
        _ball(model.ball, frame),
        tuple(
            _mate(mate, frame, number_of_mate(mate, players))
            for mate in model.mates
            if mate.age_s <= mate_timeout_s and is_sane(mate) and plausible(mate.heading_rad)
        ),
        tuple(_stranger(other, frame) for other in model.opponents if is_sane(other)),
        tuple(_stranger(other, frame) for other in model.silent_mates if is_sane(other)),
        bodies,
    )


def is_sane(robot: Estimate) -> bool:
    """Returns whether place and velocity of an estimate are plausible."""
    return plausible(robot.x_m, robot.y_m, robot.vx_m_s, robot.vy_m_s)


def _ball(ball: ball_estimate_t, frame: Frame) -> Ball:
    if not plausible(ball.x_m, ball.y_m, ball.vx_m_s, ball.vy_m_s):
        return Ball(known=False)
    return Ball(ball.known, frame.point(ball.x_m, ball.y_m), frame.point(ball.vx_m_s, ball.vy_m_s))


def _agreement(said: pass_agreement_t, frame: Frame) -> Agreement:
    if not (said.receiver or said.passer) or not plausible(said.x_m, said.y_m):
        return _SILENT
    return Agreement(said.receiver, frame.point(said.x_m, said.y_m), said.passer)


def _mate(mate: mate_estimate_t, frame: Frame, number: int) -> Robot:
    return Robot(
        mate.name,
        frame.point(mate.x_m, mate.y_m),
        frame.heading_rad(mate.heading_rad),
        frame.point(mate.vx_m_s, mate.vy_m_s),
        mate.role,
        _agreement(mate.agreement, frame),
        number,
    )


def _stranger(robot: robot_estimate_t, frame: Frame) -> Robot:
    place, velocity_m_s = frame.point(robot.x_m, robot.y_m), frame.point(robot.vx_m_s, robot.vy_m_s)
    return Robot("", place, velocity_m_s=velocity_m_s)
