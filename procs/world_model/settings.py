"""Settings of the world model."""

from pydantic import Field as Setting

from fwk import Config
from procs.model.ball import BALL, BallModel
from procs.model.expected_errors import EXPECTED
from procs.model.exposures import AHEAD_S
from procs.model.field import Field, MatchField
from procs.model.realism import Realism
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel
from procs.model.units import US_PER_S
from procs.world_model.opponents import OpponentSettings
from procs.world_model.own_view import Shaking

STALE_S = 0.5
"""Older sightings, an older odometry and older targets of the own skiller do not count."""
RESTART_S = 2.0
"""A robot whose agent is silent for longer does not play."""


def counts(age_s: float) -> bool:
    """Returns whether a sighting of this age counts: it must be neither too old nor from the future."""
    return 0.0 <= age_s <= STALE_S


class WorldModelConfig(Config):
    """Settings of the world model."""

    field: MatchField = Field()
    """Measures of the field."""
    ball_timeout_s: float = Setting(default=2.0, gt=0.0)
    """The ball is unknown after this time without a sighting."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    ball: BallModel = BALL
    """Size and friction of the ball."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    opponent_timeout_s: float = Setting(default=0.6, gt=0.0)
    """An opponent is forgotten after this time without a sighting."""
    mate_timeout_s: float = Setting(default=5.0, gt=0.0)
    """A mate is forgotten after this time without a message."""
    mate_radius_m: float = Setting(default=0.5, gt=0.0, le=100.0)
    """An obstacle this near to a mate is that mate; one further away is, too, if its place is uncertain enough."""
    obstacle_deviation_m: float = Setting(default=0.4, gt=0.0, le=100.0)
    """Obstacles seen with a larger standard deviation are not used."""
    border_m: float | None = Setting(default=None, ge=0.0, le=100.0)
    """Obstacles further outside the field than this are not robots of the match; null: those outside the walls."""
    use_team_sight: bool = True
    """Use the sightings of mates."""
    use_capture_times: bool = True
    """Let a sighting count at the time of its exposure; false, for comparison: at the time of its arrival."""
    use_ball_velocity: bool = True
    """Publish the velocity of the ball; false, for comparison: the ball always seems to rest."""
    message_period_s: float = Setting(default=0.1, gt=0.0)
    """Time from one message to the team to the next; messages go with the nearest frame of the camera."""
    sight_correlation: float = Setting(default=1.0, ge=1.0, le=1e6)
    """Number of frames that share one error of the camera; multiplies the covariance of sightings."""
    realism: Realism = "realistic"
    """Shaking of the mirror that covariances allow for: none, friendly, realistic or harsh."""
    ball_shake_s_m: float | None = Setting(default=None, ge=0.0, le=100.0)
    """Growth of a ball's deviation for each m/s of the robot, as a share of what its percept states; null: by
    `realism`."""
    robot_shake_s_m: float | None = Setting(default=None, ge=0.0, le=100.0)
    """The same of another robot's."""
    pose_correlation: float = Setting(default=2.0, ge=1.0, le=1e6)
    """Number of frames that share one error of the own pose; multiplies the covariance that the pose adds."""
    team_correlation: float = Setting(default=1.0, ge=1.0, le=1e6)
    """Number of messages of a mate that share one error; multiplies the covariance of its sightings."""

    def age_s(self, capture_us: int, now_us: int) -> float:
        """Returns the time since an exposure; `capture_us` of 0 stands for an exposure in this tick.

        So does one that is as little ahead as the clock of a camera may be.
        """
        age_s = (now_us - capture_us) / US_PER_S if capture_us and self.use_capture_times else 0.0
        return 0.0 if -AHEAD_S <= age_s < 0.0 else age_s

    @property
    def shaking(self) -> Shaking:
        """Growth of the deviations of percepts with the speed of the robot."""
        usual = EXPECTED[self.realism]
        return Shaking(
            usual.ball_shake_s_m if self.ball_shake_s_m is None else self.ball_shake_s_m,
            usual.robot_shake_s_m if self.robot_shake_s_m is None else self.robot_shake_s_m,
        )

    @property
    def mouth_m(self) -> float:
        """Distance from a robot's middle to the middle of a ball in its mouth."""
        return self.robot.held_ball_m(self.ball)

    @property
    def opponent_settings(self) -> OpponentSettings:
        """Limits for an obstacle to count as an opponent."""
        border_m = self.field.border_m if self.border_m is None else self.border_m
        return OpponentSettings(
            half_length_m=self.field.half_length_m + border_m,
            half_width_m=self.field.half_width_m + border_m,
            deviation_m=self.obstacle_deviation_m,
            mate_radius_m=self.mate_radius_m,
        )
