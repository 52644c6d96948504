"""Physical properties of motors, mouths, kickers and contacts; the defaults are those of the middle size league.

Values without a source are estimates.
"""

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator


class _Settings(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class DriveSettings(_Settings):
    """Motors and wheels."""

    motor_time_s: Annotated[float, Field(ge=0.001, le=10.0)] = 0.05
    """Time constant of the motors with their controllers."""
    traction: Annotated[float, Field(gt=0.0, le=5.0)] = 0.8
    """Largest force of a wheel divided by the weight that rests on it."""
    full_slip_m_s: Annotated[float, Field(ge=0.005, le=5.0)] = 0.05
    """Speed of the rim over the ground at which a wheel reaches about three quarters of that force."""


class HandlingSettings(_Settings):
    """Ball handling: wheels that pull the ball back into the mouth, and the light barrier that sees it there."""

    reach_m: Annotated[float, Field(gt=0.0, le=0.5)] = 0.03
    """Widest gap between ball and mouth at which ball handling, kicker and light barrier act."""
    half_width_m: Annotated[float, Field(gt=0.0, le=0.5)] = 0.10
    """Largest distance of the ball from the middle of the mouth, sideways."""
    highest_m: Annotated[float, Field(gt=0.0, le=2.0)] = 0.1
    """Height of the ball above the ground at which it is no longer in the mouth."""
    pull_m_s2: Annotated[float, Field(gt=0.0, le=1000.0)] = 15.0
    """Acceleration of the ball that ideal handling can bring about; what asks for more loses the ball."""
    centring_s: Annotated[float, Field(ge=0.01, le=10.0)] = 0.05
    """Time constant with which the ball is drawn to the middle of the mouth."""


class KickerSettings(_Settings):
    """A kicker that drives the ball straight out of the mouth along the ground."""

    recharge_s: Annotated[float, Field(gt=0.0, le=600.0)] = 1.5
    """After a kick, until the next is possible."""
    release_s: Annotated[float, Field(ge=0.0, le=600.0)] = 0.1
    """After a kick the handling wheels stand still for this time, so that they do not brake the ball."""


class ContactSettings(_Settings):
    """Bounce (0..1: share of the closing speed that is left) and friction of bodies that touch."""

    wall_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5
    """Ball at the low wall around the field."""
    post_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.7
    """Ball at a post or the bar of a goal."""
    net_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.05
    """Ball in the net of a goal."""
    hull_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5
    """Ball at a robot's side or back. ER-Force measured 0.6, TIGERs 0.2 to 0.55."""
    mouth_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.2
    """Ball at a robot's mouth. ER-Force: 0.2 at the dribbler."""
    top_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.5
    """Ball that falls on the top of a robot: share of its vertical speed that is left; as at its side."""
    roll_off_m_s: Annotated[float, Field(gt=0.0, le=5.0)] = 0.5
    """Least speed with which such a ball moves away from the robot's middle; an estimate: mirrors are not flat."""
    robot_bounce: Annotated[float, Field(ge=0.0, le=1.0)] = 0.3
    """Root of the bounce of two robots: 0.09 between them. At walls the product with theirs."""
    wall_friction: Annotated[float, Field(ge=0.0, le=10.0)] = 0.5
    """Friction of walls, posts and nets."""
    hull_friction: Annotated[float, Field(ge=0.0, le=10.0)] = 0.22
    """Friction between ball and hull. ER-Force measured 0.22."""
    mouth_friction: Annotated[float, Field(ge=0.0, le=10.0)] = 0.8
    """Friction between ball and mouth. ER-Force: 1.5 at the dribbler of a small robot."""
    robot_friction: Annotated[float, Field(ge=0.0, le=10.0)] = 0.3
    """Root of the friction of two robots."""


class BatterySettings(_Settings):
    """Battery, and what takes energy out of it. A match of 2 x 15 minutes with its stops has to fit into one charge."""

    capacity_wh: Annotated[float, Field(gt=0.0, le=1e6)] = 260.0
    """Energy of a full battery in watt-hours: seven lithium cells in a row of 10 Ah and 3.7 V; an estimate."""
    full_v: Annotated[float, Field(gt=0.0, le=1000.0)] = 29.4
    """Voltage of a full battery in volts: seven cells of 4.2 V, as data sheets of lithium cells say."""
    empty_v: Annotated[float, Field(gt=0.0, le=1000.0)] = 21.0
    """Voltage at which it counts as empty, in volts: seven cells of 3.0 V, as data sheets of lithium cells say."""
    idle_w: Annotated[float, Field(ge=0.0, le=1e6)] = 100.0
    """Power in watts of computer, cameras and electronics, whatever the robot does; an estimate."""
    drive_efficiency: Annotated[float, Field(gt=0.0, le=1.0)] = 0.6
    """Work of the wheels at their rims divided by the energy that motors and gears take for it; an estimate."""
    rolling_resistance: Annotated[float, Field(ge=0.0, le=1.0)] = 0.03
    """Force that a wheel on the carpet costs, divided by the weight on it; an estimate. It takes energy only: the
    simulated wheels are not braked by it."""
    kick_efficiency: Annotated[float, Field(gt=0.0, le=1.0)] = 0.05
    """Energy of the kicked ball divided by the energy that charges the kicker for it; an estimate: a ball of 0.43 kg
    at 12 m/s has 31 J, and the capacitor of such a kicker holds some hundred."""

    @model_validator(mode="after")
    def _full_is_higher(self) -> Self:
        if self.full_v < self.empty_v:
            raise ValueError(f"full_v is {self.full_v} V, below empty_v of {self.empty_v} V; it should be above")
        return self


class PhysicsSettings(_Settings):
    """Parameters of the world's motion, besides field, robots and ball."""

    drive: DriveSettings = DriveSettings()
    handling: HandlingSettings = HandlingSettings()
    kicker: KickerSettings = KickerSettings()
    contacts: ContactSettings = ContactSettings()
    battery: BatterySettings = BatterySettings()
    step_s: Annotated[float, Field(ge=0.0001, le=0.005)] = 0.005
    """Longest step of the integration; a tick is cut into equal steps no longer than this. With a small
    `full_slip_m_s`, much traction or wheels far out, the force of a wheel would oscillate with its slip, and a small
    ball would get through nets; steps are then shorter."""
