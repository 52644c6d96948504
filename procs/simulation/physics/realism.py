"""How far the simulated hardware is from ideal: named presets from none to harsh."""

from typing import Literal

from pydantic import BaseModel, ConfigDict

Realism = Literal["none", "friendly", "realistic", "harsh"]


class Noise(BaseModel):
    """Errors and delays of actuators and sensors; `_sd` is a standard deviation."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)

    drive_delay_s: float = 0.0
    """From the arrival of a wheel command until the motors follow it."""
    kick_delay_s: float = 0.0
    """From the arrival of a kicker command until the kicker follows it."""
    kick_direction_sd_deg: float = 0.0
    kick_speed_sd: float = 0.0
    """Relative error of a kick's speed."""
    friction_spread: float = 0.0
    """The ball's sliding and rolling deceleration are scaled by a factor between one minus and one plus this."""
    wheel_scale_sd: float = 0.0
    """Relative error of each wheel's encoder, constant in a match."""
    wheel_speed_sd: float = 0.0
    """Relative error of each wheel's measured speed, new in each tick."""
    compass_sd_rad: float = 0.0
    """Error of the compass, new in each tick."""
    compass_drift_sd_rad: float = 0.0
    """Drift of the compass after one minute; it grows with the square root of time."""
    gyro_sd_rad_s: float = 0.0
    """Error of the measured yaw rate, new in each tick."""


PRESETS: dict[Realism, Noise] = {
    "none": Noise(),
    "friendly": Noise(
        drive_delay_s=0.02,
        kick_delay_s=0.01,
        kick_direction_sd_deg=0.5,
        kick_speed_sd=0.01,
        friction_spread=0.1,
        wheel_scale_sd=0.01,
        wheel_speed_sd=0.02,
        compass_sd_rad=0.01,
        compass_drift_sd_rad=0.01,
        gyro_sd_rad_s=0.01,
    ),
    "realistic": Noise(
        drive_delay_s=0.06,
        kick_delay_s=0.02,
        kick_direction_sd_deg=1.0,
        kick_speed_sd=0.03,
        friction_spread=0.3,
        wheel_scale_sd=0.03,
        wheel_speed_sd=0.05,
        compass_sd_rad=0.03,
        compass_drift_sd_rad=0.03,
        gyro_sd_rad_s=0.02,
    ),
    "harsh": Noise(
        drive_delay_s=0.1,
        kick_delay_s=0.04,
        kick_direction_sd_deg=2.0,
        kick_speed_sd=0.06,
        friction_spread=0.5,
        wheel_scale_sd=0.06,
        wheel_speed_sd=0.1,
        compass_sd_rad=0.06,
        compass_drift_sd_rad=0.06,
        gyro_sd_rad_s=0.04,
    ),
}
