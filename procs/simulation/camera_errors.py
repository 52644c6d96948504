"""Deviation of the simulated camera from the ideal, for each preset."""

from pydantic import BaseModel, ConfigDict

from procs.model.realism import Realism


class CameraErrors(BaseModel):
    """Errors of a camera with its mirror. 0: ideal."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    latency_s: float = 0.0
    """From the exposure until the frame is published. ER-Force: 35 ms, MRA: 25 ms."""
    shake_px: float = 0.0
    """Standard deviation by which the standing robot's mirror shakes the picture."""
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


PRESETS: dict[Realism, CameraErrors] = {
    "none": CameraErrors(),
    "friendly": CameraErrors(latency_s=0.02, shake_px=0.1, shake_px_per_m_s=0.15, noise_levels=3.0),
    "realistic": CameraErrors(latency_s=0.035, shake_px=0.2, shake_px_per_m_s=0.3, noise_levels=5.0),
    "harsh": CameraErrors(
        latency_s=0.07,
        shake_px=0.4,
        shake_px_per_m_s=0.6,
        noise_levels=10.0,
        flicker=0.04,
        blur_px=0.6,
        vignette=0.15,
    ),
}
