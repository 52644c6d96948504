"""Deviation of the simulated bodies from the ideal: named presets from none to harsh.

`realistic` has the values that teams report, `friendly` about a third of them, `harsh` one and a half times to twice as
much, like the realism files of ER-Force's simulator. Values without a source are estimates.
"""

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, ValidationError

from procs.model.geometry import clamp
from procs.model.realism import Realism


class Noise(BaseModel):
    """Errors and delays of actuators and sensors; `_sd` is a standard deviation. 0: ideal."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    drive_delay_s: float = Field(default=0.0, ge=0.0, le=1.0)
    """From the arrival of a wheel command until the motors follow it. CAMBADA: 140 ms, Tribots: 200 ms for the loop."""
    kick_delay_s: float = Field(default=0.0, ge=0.0, le=1.0)
    """From the arrival of a kicker command until the kicker follows it. NuBot: 100 ms with a relay."""
    kick_direction_sd_deg: float = Field(default=0.0, ge=0.0, le=90.0)
    """Error of a kick's direction, of 90 degrees at most. CAMBADA accepts 1 degree."""
    kick_speed_sd: float = Field(default=0.0, ge=0.0, le=1.0)
    """Relative error of a kick's speed, of 100 % at most: no kick drives the ball backwards."""
    friction_spread: float = Field(default=0.0, ge=0.0, lt=1.0)
    """The ball's sliding and rolling deceleration are scaled by a factor between one minus and one plus this; 30 %
    cover the published values."""
    handling_loss: float = Field(default=0.0, ge=0.0, le=1.0)
    """Share of the ball handling's force that is missing; the handling loses a ball that asks for more."""
    wheel_scale_sd: float = Field(default=0.0, ge=0.0, le=1.0)
    """Relative error of each wheel's encoder, of 100 % at most, constant in a match. Twente: a constant factor for each
    axis."""
    wheel_noise_sqrt_s: float = Field(default=0.0, ge=0.0, le=10.0)
    """Relative error of the way that a wheel measures in one second, with steady speed. Tick by tick it is larger by
    the square root of the ticks in a second, but 100 % at most."""
    compass_noise_sqrt_s: float = Field(default=0.0, ge=0.0, le=10.0)
    """Error in rad of the compass averaged over one second."""
    compass_drift_sd_rad: float = Field(default=0.0, ge=0.0, le=10.0)
    """Drift of the compass after one minute; it grows with the square root of time."""
    gyro_noise_sqrt_s: float = Field(default=0.0, ge=0.0, le=10.0)
    """Error in rad of the heading that the gyro measures in one second."""
    gyro_bias_sd_rad_s: float = Field(default=0.0, ge=0.0, le=10.0)
    """Constant error of the yaw rate; 0.1 degrees a second are usual for cheap gyros."""


PRESETS: dict[Realism, Noise] = {
    "none": Noise(),
    "friendly": Noise(
        drive_delay_s=0.02,
        kick_delay_s=0.01,
        kick_direction_sd_deg=0.5,
        kick_speed_sd=0.01,
        friction_spread=0.1,
        handling_loss=0.2,
        wheel_scale_sd=0.01,
        wheel_noise_sqrt_s=0.0045,
        compass_noise_sqrt_s=0.0022,
        compass_drift_sd_rad=0.01,
        gyro_noise_sqrt_s=0.0022,
        gyro_bias_sd_rad_s=0.0005,
    ),
    "realistic": Noise(
        drive_delay_s=0.06,
        kick_delay_s=0.02,
        kick_direction_sd_deg=1.0,
        kick_speed_sd=0.03,
        friction_spread=0.3,
        handling_loss=0.4,
        wheel_scale_sd=0.03,
        wheel_noise_sqrt_s=0.0112,
        compass_noise_sqrt_s=0.0067,
        compass_drift_sd_rad=0.03,
        gyro_noise_sqrt_s=0.0045,
        gyro_bias_sd_rad_s=0.0017,
    ),
    "harsh": Noise(
        drive_delay_s=0.1,
        kick_delay_s=0.04,
        kick_direction_sd_deg=2.0,
        kick_speed_sd=0.06,
        friction_spread=0.5,
        handling_loss=0.6,
        wheel_scale_sd=0.06,
        wheel_noise_sqrt_s=0.0224,
        compass_noise_sqrt_s=0.0134,
        compass_drift_sd_rad=0.06,
        gyro_noise_sqrt_s=0.009,
        gyro_bias_sd_rad_s=0.0035,
    ),
}


def _checked(changes: dict[str, float]) -> dict[str, float]:
    for name in sorted(set(changes) - set(Noise.model_fields)):
        raise ValueError(f"no error '{name}'; there are {', '.join(Noise.model_fields)}")
    try:
        Noise(**changes)
    except ValidationError as error:
        mistakes = [found["msg"].replace("Input", str(found["loc"][0])) for found in error.errors()]
        raise ValueError("; ".join(mistakes)) from None
    return changes


Changes = Annotated[dict[str, float], AfterValidator(_checked)]
"""Errors by name that differ from those of a preset."""


def noise_of(realism: Realism, changes: dict[str, float]) -> Noise:
    """Returns the errors of a preset with changes."""
    return PRESETS[realism].model_copy(update=changes)


def factor(deviation: float, drawn: float) -> float:
    """Returns the factor of a quantity with a relative error of this standard deviation, from a standard normal draw.

    It is from 0 to 2: no error turns a quantity around, and the mean stays 1.
    """
    return clamp(1.0 + deviation * drawn, 0.0, 2.0)
