"""The robot of the middle size league: its geometry, and the players of a match by team and number."""

import math
from collections.abc import Mapping
from functools import lru_cache
from string import digits
from typing import Annotated, Literal, Protocol

from pydantic import BaseModel, ConfigDict, Field

from fwk import Alike
from procs.model.ball import BallModel

CYAN, MAGENTA = "cyan", "magenta"
"""Cyan defends the goal at negative x in the first half."""
TEAM_NUMBERS = {CYAN: 1, MAGENTA: 2}
"""Number of each team in messages; 0 is none, or unknown."""

FASTEST_M_S, FASTEST_RAD_S = 8.0, 15.0
"""Speeds that no robot exceeds."""

NUMBER_MAX = 2**31 - 1
"""Largest number of a robot; a greater one does not fit into messages."""

_DIGITS_MAX = len(str(NUMBER_MAX))
_NAMES_MAX = 4096  # of which team and number are remembered: the radio may bring any number of names


class RobotModel(BaseModel):
    """A round robot on three omnidirectional wheels with a flat mouth in front; all robots of a match are equal."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    radius_m: float = Field(default=0.25, ge=0.05, le=0.5)
    """Radius of the round body, in metres. Rule book of 2016: a footprint of 0.30 to 0.52 m."""
    height_m: float = Field(default=0.6, ge=0.05, le=2.0)
    """Height of the body, in metres; the team markers are below. Rule book of 2016: 0.40 to 0.80 m."""
    mass_kg: float = Field(default=35.0, ge=1.0, le=200.0)
    """Mass of the whole robot, in kilograms. The robots of simatch have 31 to 39 kg."""
    inertia: float = Field(default=0.5, ge=0.1, le=1.0)
    """Moment of inertia divided by mass and squared radius: 1/2 for a solid disc, 1 for a ring. An estimate."""
    wheel_distance_m: float = Field(default=0.2, ge=0.02, le=0.5)
    """Distance from the robot's middle to each wheel, in metres. An estimate."""
    wheel_limit_m_s: float = Field(default=3.5, gt=0.0, le=20.0)
    """Highest rim speed of the wheels, in m/s. An estimate: in a match of Tech United in 2016 robots drove up to
    2.7 m/s 99 % of the time, and 4.0 m/s at most; simatch allows 5 m/s."""
    kick_limit_m_s: float = Field(default=12.0, gt=1.0, le=20.0)
    """Highest speed of a kicked ball, in m/s, at any elevation. MRA considers up to 12 m/s plausible."""
    mouth_half_angle_deg: float = Field(default=30.0, gt=0.0, lt=90.0)
    """The front is cut off between these angles to the left and the right of forward. An estimate."""

    @property
    def marker_m(self) -> tuple[float, float]:
        """Heights of the lower and the upper edge of the team marker, in metres. Rule book of 2016: 0.30 to 0.60 m."""
        upper_m = min(0.5, self.height_m)
        return 0.68 * upper_m, upper_m

    @property
    def mouth_m(self) -> float:
        """Distance from the robot's middle to the plane of the mouth, in metres."""
        return self.radius_m * math.cos(math.radians(self.mouth_half_angle_deg))

    @property
    def fastest_ball_m_s(self) -> float:
        """Speed in m/s that no kicked ball exceeds: the hardest kick of a robot that drives ahead at its limit."""
        return self.kick_limit_m_s + self.wheel_limit_m_s

    def held_ball_m(self, ball: BallModel) -> float:
        """Returns the distance from the robot's middle to the middle of a ball in the mouth."""
        return self.mouth_m + ball.radius_m

    def kicked_m_s(self, speed_m_s: float, elevation_rad: float) -> float:
        """Returns the horizontal speed in m/s that a requested kick gets; `kick_limit_m_s` limits the total speed."""
        return min(speed_m_s, self.kick_limit_m_s * math.cos(elevation_rad))


ROBOT = RobotModel()
"""The usual robot."""


class Player(BaseModel):
    """A robot's place in the match."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    team: Literal["cyan", "magenta"]
    """Cyan defends the goal at negative x in the first half."""
    number: int = Field(ge=1, le=NUMBER_MAX)
    """Number on the robot's back; no two players of a team have the same."""


Players = Annotated[dict[str, Player], Field(frozen=True), Alike]
"""Namespace of each robot to its team and number; no component of a match changes them while it runs."""

PLAYERS: Mapping[str, Player] = {
    f"{team}{number}": Player(team=team, number=number) for team in ("cyan", "magenta") for number in range(1, 6)
}
"""Five against five, by their usual names."""

ABSENT = "absent"
"""Role of a robot that is off the field, or on its way there."""


@lru_cache(maxsize=_NAMES_MAX)
def team_of(robot: str) -> str:
    """Returns the letters before the number: `cyan3` gives `cyan`."""
    return robot.rstrip(digits)


@lru_cache(maxsize=_NAMES_MAX)
def number_of(robot: str) -> int:
    """Returns the number at the end of the name; 0 for a name without a number, or with one above `NUMBER_MAX`."""
    found = robot[len(team_of(robot)) :].lstrip("0")
    number = int(found) if 0 < len(found) <= _DIGITS_MAX else 0
    return number if number <= NUMBER_MAX else 0


def player_of(robot: str, players: Mapping[str, Player]) -> Player | None:
    """Returns team and number of a robot: those stated in `players`, otherwise those of its name, such as `cyan6`.

    A robot that is not among them and whose name is not a team and a number is not a player.
    """
    team, number = team_of(robot), number_of(robot)
    if robot in players or number < 1 or (team != CYAN and team != MAGENTA):
        return players.get(robot)
    return Player(team=team, number=number)


def number_of_player(robot: str, players: Mapping[str, Player]) -> int:
    """Returns the number of a robot by its namespace; without a player of that name, the number in the name."""
    player = players.get(robot)
    return player.number if player else number_of(robot)


def team_of_player(robot: str, players: Mapping[str, Player]) -> str:
    """Returns the team of a robot by its namespace; without a player of that name, the letters of the name."""
    player = players.get(robot)
    return player.team if player else team_of(robot)


class Numbered(Protocol):
    """A message about a robot of the own team."""

    name: str
    number: int


class Named(Numbered, Protocol):
    """A message about a robot."""

    team: str


def number_of_mate(mate: Numbered, players: Mapping[str, Player]) -> int:
    """Returns the number that a message states about a mate; that of the player if it states none above 0."""
    return mate.number if mate.number > 0 else number_of_player(mate.name, players)


def team_in(robot: Named) -> str:
    """Returns the team that a message states; that of the robot's name where it states none."""
    return robot.team or team_of(robot.name)


def number_in(robot: Named) -> int:
    """Returns the number that a message states; that of the robot's name where it states none."""
    return robot.number or number_of(robot.name)


def side_of(team: str) -> float:
    """Returns the side of the goal that the team defends: +1.0 for magenta, -1.0 for cyan and for any other team."""
    return 1.0 if team == MAGENTA else -1.0
