"""Times and limits of a match.

The defaults are those of the rule book of the middle size league: of 2016 unless another year is named. Values without
a year are the simulation's own.
"""

from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat, NonNegativeInt, PositiveFloat

from procs.model.ball import BALL, BallModel
from procs.model.field import Field as SoccerField
from procs.model.field import MatchField
from procs.model.game_states import State
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel

LEAST_HALF_S = 0.1
"""Shortest half: a few ticks, so that a half begins before it ends."""


class Rules(BaseModel):
    """Times and limits of a match."""

    model_config = ConfigDict(extra="forbid")

    automatic: bool = True
    """The referee decides by itself; false: it only carries out commands, of a person or a RefBox.

    Without commands a set piece then becomes play when it has been taken or its time is over, robots come back when
    their time beside the field is over, and a ball that is pushed off its spot in a stoppage is put back.
    """
    half_s: float = Field(default=900.0, ge=LEAST_HALF_S)
    """Length of a half, stoppages included (2016: 15 min)."""
    half_time_s: NonNegativeFloat = 5.0
    """Break between the halves (2016: at most 10 min)."""
    first_kick_off: Literal["cyan", "magenta"] = "cyan"
    """Team with the kick-off of the first half, which a coin decides (2016); the other begins the second half."""
    change_ends: bool = True
    """The teams change ends after each half (2016)."""
    decide: bool = False
    """A draw is followed by overtime, and a further draw by penalties (2016)."""
    overtime_half_s: float = Field(default=300.0, ge=LEAST_HALF_S)
    """Length of each of the two halves of the overtime (2016: 5 min)."""
    penalties: int = Field(default=5, ge=1)
    """Penalties of each team after a drawn overtime; further pairs follow until one decides (2016)."""
    shot_s: PositiveFloat = 30.0
    """Time for such a penalty, from the start to the goal (2016)."""
    least_robots: int = Field(default=1, ge=1, le=5)
    """A set piece waits until each team that plays has so many robots on the field (2016: 2).

    A team whose robots are all beside the field for a while plays; one whose robots all have red cards does not.
    """
    kick_off_stoppage_s: NonNegativeFloat = 6.0
    """From a goal or the beginning of a half until the kick-off may be taken."""
    stoppage_s: NonNegativeFloat = 3.0
    """From an interruption until the set piece may be taken."""
    positions_s: NonNegativeFloat = 6.0
    """Longest further wait for a ball that rolls, and for robots that are too near to it or in the wrong half.

    It begins anew when the ball was pushed off its spot and has been put back, twice at most.
    """
    ends_s: NonNegativeFloat = 20.0
    """Longest such wait at the beginning of a half, when the robots may have changed ends."""
    own_m: float = Field(default=2.0, ge=0.0, le=10.0)
    """Least distance to the ball of the team that takes a set piece, except for the taker (2016: 2 m)."""
    theirs_m: float = Field(default=3.0, ge=0.0, le=10.0)
    """Least distance of the other team, except for one robot in its own penalty area (2016: 3 m)."""
    dropped_m: float = Field(default=1.0, ge=0.0, le=10.0)
    """Least distance of every robot at a dropped ball (2016: 1 m)."""
    tolerance_m: float = Field(default=0.05, ge=0.0, le=2.0)
    """A set piece does not wait for a robot that is nearer, or further in the wrong half, by less than this."""
    intrusion_m: float = Field(default=0.3, ge=0.0, le=2.0)
    """A robot may come nearer, or into the other half, by so much before the set piece is repeated."""
    repeats: NonNegativeInt = 2
    """A set piece is repeated so often after breaches; then the game goes on in spite of them."""
    corner_inset_m: float = Field(default=0.2, ge=0.0, le=2.0)
    """Distance of a corner kick's ball from both lines."""
    throw_in_inset_m: float = Field(default=0.1, ge=0.0, le=2.0)
    """Distance of a throw-in's ball from the touch line."""
    free_kick_inset_m: float = Field(default=0.5, ge=0.0, le=2.0)
    """Least distance of a free kick's ball from the touch lines."""
    set_piece_s: PositiveFloat = 7.0
    """Time for a set piece; after it the other team may play the ball, too (2016: 7 s)."""
    moved_m: PositiveFloat = 0.5
    """A set piece has been taken when the ball has rolled so far without a touch (2016: 0.5 m)."""
    penalty_s: PositiveFloat = 10.0
    """Within this time the taker of a penalty that decides no match must reach the ball (2016: 10 s)."""
    pass_m: PositiveFloat = 1.0
    """A team that won the ball in its own half must pass it so far before a goal counts (2016: 1 m)."""
    lost_s: PositiveFloat = 0.25
    """A robot that does not touch the ball for longer does not carry it any more."""
    free_m: PositiveFloat = 0.5
    """Nor does a robot from which the ball has rolled further than this."""
    won_s: PositiveFloat = 0.5
    """A robot that carries the ball for longer has won it, and did not only turn it."""
    deadlock_s: PositiveFloat = 10.0
    """A ball that stays within `deadlock_m` for so long is dropped elsewhere."""
    deadlock_m: PositiveFloat = 0.5
    """Way of a ball that counts as staying in its place."""
    collision_m_s: PositiveFloat = 3.0
    """Closing speed above which a collision is a foul of the faster robot."""
    pushing_m: PositiveFloat = 0.4
    """A robot that drives a rival so far before itself commits a foul."""
    contact_m: NonNegativeFloat = 0.005
    """Robots whose gap is larger do not touch each other."""
    apart_m: NonNegativeFloat = 0.02
    """A push is over when the gap is larger; smaller ones come from bounces."""
    shove_m_s: NonNegativeFloat = 0.1
    """Two robots that move faster than this in the pusher's direction are a push."""
    dribbling_m: PositiveFloat = 3.0
    """Longest way with the ball without setting it free (2019: 3 m)."""
    holding_s: PositiveFloat = 1.0
    """Longest time for which a robot may keep the ball from rolling (2016: 1 s)."""
    holding_m: PositiveFloat = 0.3
    """Longest way on which a robot may pull the ball back (2016: 0.30 m)."""
    still_m_s: NonNegativeFloat = 0.1
    """A ball that is not faster does not roll."""
    back_m_s: NonNegativeFloat = 0.05
    """A ball that comes faster than this towards its carrier is pulled back."""
    holding_pause_s: PositiveFloat = 4.0
    """Holding is counted anew after this time without it (2016: 4 s)."""
    area_s: PositiveFloat = 10.0
    """Longest stay of a field player in a penalty area (2016: 10 s)."""
    grace_s: PositiveFloat = 1.0
    """A robot too many in an area leaves it within this time, or commits a foul."""
    advantage_s: NonNegativeFloat = 3.0
    """For so long a foul is held back while the team that suffers it has the ball (2016: the referee's judgement)."""
    fouls_per_card: int = Field(default=3, ge=1)
    """Number of fouls of a robot that bring a yellow card."""
    double_yellow_s: PositiveFloat = 90.0
    """A robot with its second yellow card leaves the field for this time (RefBox: 90 s)."""
    repair_s: PositiveFloat = 20.0
    """A robot under repair, or its substitute, comes back after this time (RefBox: 20 s)."""
    field: MatchField = SoccerField()
    """Measures of the field."""
    robot: RobotModel = ROBOT
    """Geometry of the robots, by which pushing is judged."""
    ball: BallModel = BALL
    """Size of the ball, which is out when it is wholly over a line."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""

    def time_of_s(self, piece: State) -> float:
        """Returns the time for a set piece; after it the other team may play the ball, too."""
        return self.penalty_s if piece is State.PENALTY else self.set_piece_s
