"""Interface of the skills: once a tick a scene goes in and a step comes out; attack frame."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from enum import IntEnum
from typing import NamedTuple

from procs.behaviour.game import Game
from procs.behaviour.view import View
from procs.model.field import Field, Point


class Status(IntEnum):
    """Progress of a skill; the numbers are those of the message, after the Fawkes skiller."""

    INACTIVE = 0
    FINAL = 1
    RUNNING = 2
    FAILED = 3


class Obstacle(NamedTuple):
    """An obstacle in the robot frame."""

    place: Point
    radius_m: float


class Sight(NamedTuple):
    """Sight of the robot's own camera at the moment, in the robot frame: a lost robot knows nothing else."""

    obstacles: tuple[Obstacle, ...] = ()
    lines: tuple[Point, ...] = ()
    """Points on white lines."""


def _anywhere(place: Point) -> Point:
    return place


class Scene(NamedTuple):
    """Input of a skill."""

    view: View
    place: Point
    """Target of the order."""
    heading_rad: float
    speed_m_s: float = 0.0
    """Limit of the order; 0: the robot's own."""
    holds_ball: bool = False
    charged: bool = True
    kicked: bool | None = None
    """Whether the kicker has carried out the newest kick; None: not known yet, or none was asked for."""
    set_piece: bool = False
    """The ball lies still and waits for the own team."""
    duration_s: float = 0.05
    """Since the last scene."""
    field: Field = Field()
    game: Game = Game()
    """State of the game."""
    sight: Sight | None = None
    """None: nothing was seen lately, or the robot knows its place."""
    permitted: Callable[[Point], Point] = _anywhere
    """Gives the place nearest to a target where the robot may stand, which is where a drive there ends."""


class Drive(NamedTuple):
    """Target of a drive."""

    place: Point
    heading_rad: float
    speed_m_s: float = 0.0
    end_speed_m_s: float = 0.0
    avoid_ball: bool = False
    avoid_robots: bool = True


class Blind(NamedTuple):
    """Velocity of a robot that does not know its place, in the robot frame."""

    ahead_m_s: float
    turn_rad_s: float


class Step(NamedTuple):
    """Output of a skill; without a drive the robot stops."""

    drive: Drive | None = None
    dribble: bool = False
    kick_m_s: float = 0.0
    """Above 0: kick now with that horizontal speed, relative to the robot."""
    elevation_rad: float = 0.0
    """Elevation of that kick; 0.0: along the ground."""
    status: Status = Status.RUNNING
    reason: str = ""
    blind: Blind | None = None
    """In the place of a drive while the robot does not know its place."""


class Skill(ABC):
    """One skill from its start to its end; a fresh object for every new command of another kind."""

    lasting = False
    """True if the skill goes on at its end, to keep its place."""

    @abstractmethod
    def step(self, scene: Scene) -> Step:
        """Runs one tick."""
