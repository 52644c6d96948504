"""Physical properties of ball, robots and kickers; the defaults are those of the middle size league."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, PositiveFloat

from procs.model import ball


class _Settings(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class BallSettings(_Settings):
    """A football of size 5 on short carpet."""

    radius_m: PositiveFloat = ball.RADIUS_M
    mass_kg: PositiveFloat = ball.MASS_KG
    sliding_m_s2: PositiveFloat = ball.SLIDING_M_S2
    """Deceleration while the ball slides, as it does after a kick."""
    rolling_m_s2: PositiveFloat = ball.ROLLING_M_S2
    """Deceleration while it rolls."""
    inertia: PositiveFloat = ball.INERTIA
    """Moment of inertia divided by mass and squared radius: 2/3 for a thin shell, 2/5 for a solid ball."""


class RobotSettings(_Settings):
    """A round robot on three omnidirectional wheels with a flat mouth in front."""

    radius_m: PositiveFloat = 0.25
    mass_kg: PositiveFloat = 35.0
    wheel_distance_m: PositiveFloat = 0.2
    """From the robot's middle to each wheel."""
    wheel_limit_m_s: PositiveFloat = 3.5
    """Highest rim speed."""
    motor_time_s: PositiveFloat = 0.05
    """Time constant of the motors with their controllers."""
    traction: PositiveFloat = 0.8
    """Largest force of a wheel divided by the weight that rests on it."""
    full_slip_m_s: PositiveFloat = 0.05
    """Speed of the rim over the ground at which a wheel reaches about three quarters of that force."""
    mouth_half_angle_deg: PositiveFloat = 30.0
    """The front is cut off between these angles to the left and the right of forward."""


class HandlingSettings(_Settings):
    """Ball handling: wheels that pull the ball back into the mouth, and the light barrier that sees it there."""

    reach_m: PositiveFloat = 0.03
    """Widest gap between ball and mouth at which ball handling, kicker and light barrier act."""
    half_width_m: PositiveFloat = 0.10
    """How far beside the middle of the mouth the ball may be."""
    pull_m_s2: PositiveFloat = 15.0
    """Acceleration of the ball that the handling can bring about; what asks for more loses the ball."""
    centring_s: PositiveFloat = 0.05
    """Time constant with which the ball is drawn to the middle of the mouth."""


class KickerSettings(_Settings):
    """A kicker that drives the ball straight out of the mouth along the ground."""

    limit_m_s: PositiveFloat = 12.0
    """Highest speed it gives to a resting ball."""
    recharge_s: PositiveFloat = 1.5
    """After a kick, until the next is possible."""


class PhysicsSettings(_Settings):
    """Everything that the world's motion depends on."""

    ball: BallSettings = BallSettings()
    robot: RobotSettings = RobotSettings()
    handling: HandlingSettings = HandlingSettings()
    kicker: KickerSettings = KickerSettings()
    step_s: Annotated[float, Field(gt=0.0, le=0.005)] = 0.005
    """Longest step of the integration; a tick is cut into equal steps no longer than this. In longer steps than 5 ms
    the force of a wheel, which is steep in its slip, oscillates."""
