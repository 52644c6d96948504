"""Sizes of the robots and the ball, and the ball's friction, as behaviour needs them."""

from typing import NamedTuple

from procs.model.ball import BALL, BallModel
from procs.model.robot import ROBOT, RobotModel


class Bodies(NamedTuple):
    """Measures of the robots, which are all equal, and of the ball; computed once from the settings."""

    robot_radius_m: float
    robot_height_m: float
    ball_radius_m: float
    held_ball_m: float
    """Distance from the middle of a robot to the middle of the ball in its mouth."""
    beside_m: float
    """Distance from the middle of a robot to the middle of a ball that touches the robot's side."""
    sliding_m_s2: float
    """Deceleration of the sliding ball."""
    rolling_m_s2: float
    """Deceleration of the rolling ball."""
    kick_limit_m_s: float
    """Highest speed of a kicked ball."""
    rolling_share: float
    """Share of a kick's speed that is left when the ball begins to roll."""

    @classmethod
    def of(cls, robot: RobotModel, ball: BallModel) -> "Bodies":
        """Returns the measures of such robots and such a ball."""
        return cls(
            robot.radius_m,
            robot.height_m,
            ball.radius_m,
            held_ball_m=robot.held_ball_m(ball),
            beside_m=robot.radius_m + ball.radius_m,
            sliding_m_s2=ball.sliding_m_s2,
            rolling_m_s2=ball.rolling_m_s2,
            kick_limit_m_s=robot.kick_limit_m_s,
            rolling_share=ball.rolling_share,
        )


USUAL = Bodies.of(ROBOT, BALL)
"""The usual robots and the usual ball."""
