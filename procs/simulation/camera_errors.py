"""Deviation of the simulated camera from the ideal, for each preset. Values without a source are estimates."""

from procs.model.realism import Realism
from procs.simulation.mirror_errors import MIRRORS, MirrorErrors


class CameraErrors(MirrorErrors):
    """Errors of a camera with its mirror. 0: ideal."""

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
    worn: float = 0.0
    """Part of the lines' paint that is missing."""
    clutter_1_m2: float = 0.0
    """White specks on a square metre of the floor around the field."""


PRESETS: dict[Realism, CameraErrors] = {
    "none": CameraErrors(**dict(MIRRORS["none"])),
    "friendly": CameraErrors(**dict(MIRRORS["friendly"]), noise_levels=3.0),
    "realistic": CameraErrors(
        **dict(MIRRORS["realistic"]),
        noise_levels=5.0,
        flicker=0.02,
        vignette=0.075,
        cast=0.025,
        worn=0.075,
        clutter_1_m2=0.15,
    ),
    "harsh": CameraErrors(
        **dict(MIRRORS["harsh"]),
        noise_levels=10.0,
        flicker=0.04,
        blur_px=0.6,
        vignette=0.15,
        cast=0.05,
        worn=0.15,
        clutter_1_m2=0.3,
    ),
}
