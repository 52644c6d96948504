"""Deviation of the simulated camera from the ideal, for each preset. Values without a source are estimates."""

from pydantic import BaseModel, ConfigDict

from procs.model.realism import Realism


class CameraErrors(BaseModel):
    """Errors of a camera with its mirror. 0: ideal."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    latency_s: float = 0.0
    """From the exposure until the frame is published. ER-Force: 35 ms, MRA: 25 ms."""
    shake_px: float = 0.0
    """Standard deviation by which the standing robot's mirror shakes the picture, before rounding: pictures move in
    steps of half a pixel, so that 0.1 px become 0.06 px, 0.2 px 0.23 px and 0.4 px 0.43 px."""
    shake_px_per_m_s: float = 0.0
    """Growth of that deviation with each m/s; 0.3 gives about CAMBADA's deviation at 4 m for a robot that drives."""
    noise_levels: float = 0.0
    """Standard deviation of the sensor noise, of 255."""
    flicker: float = 0.0
    """Standard deviation of the brightness from frame to frame, as a part of it."""
    blur_px: float = 0.0
    """Standard deviation of the blur of lens and motion."""
    vignette: float = 0.0
    """Part of the brightness that is missing at the picture's edge."""
    cast: float = 0.0
    """Standard deviation of a factor on each of the three colours, constant in a match."""
    tilt_sd_deg: float = 0.0
    """Standard deviation of the mirror's uncalibrated tilt about the robot's x and y axis, constant in a match."""
    worn: float = 0.0
    """Part of the lines' paint that is missing."""
    clutter_1_m2: float = 0.0
    """White specks on a square metre of the floor around the field."""
    gaps_1_min: float = 0.0
    """Interruptions in a minute, in which frames are lost in a row."""
    gap_s: float = 0.0
    """Mean duration of an interruption."""


PRESETS: dict[Realism, CameraErrors] = {
    "none": CameraErrors(),
    "friendly": CameraErrors(latency_s=0.02, shake_px=0.1, shake_px_per_m_s=0.15, noise_levels=3.0),
    "realistic": CameraErrors(
        latency_s=0.035,
        shake_px=0.2,
        shake_px_per_m_s=0.3,
        noise_levels=5.0,
        flicker=0.02,
        vignette=0.075,
        cast=0.025,
        tilt_sd_deg=0.05,
        worn=0.075,
        clutter_1_m2=0.15,
        gaps_1_min=1.0,
        gap_s=0.15,
    ),
    "harsh": CameraErrors(
        latency_s=0.07,
        shake_px=0.4,
        shake_px_per_m_s=0.6,
        noise_levels=10.0,
        flicker=0.04,
        blur_px=0.6,
        vignette=0.15,
        cast=0.05,
        tilt_sd_deg=0.3,
        worn=0.15,
        clutter_1_m2=0.3,
        gaps_1_min=2.0,
        gap_s=0.3,
    ),
}
