"""Errors that a camera with its mirror has whether its picture is rendered or only its percepts, for each preset.

Values without a source are estimates.
"""

import math

import numpy as np
from pydantic import BaseModel, ConfigDict

from lcmtypes.soccer import true_robot_t
from procs.model.realism import Realism


class MirrorErrors(BaseModel):
    """Errors of exposure, mount and connection. 0: ideal."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    latency_s: float = 0.0
    """Time from the exposure until the frame or its percepts are published. ER-Force: 35 ms, MRA: 25 ms."""
    shake_px: float = 0.0
    """Standard deviation by which the standing robot's mirror shakes everything that a frame shows, in pixels. Frames
    move in steps of half a pixel, so that 0.1 px become 0.06 px there, 0.2 px 0.23 px and 0.4 px 0.43 px."""
    shake_px_per_m_s: float = 0.0
    """Growth of that deviation with each m/s; 0.3 gives about CAMBADA's deviation at 4 m for a robot that drives."""
    tilt_sd_deg: float = 0.0
    """Standard deviation of the mirror's uncalibrated tilt about the robot's x and y axis, constant in a match."""
    gaps_1_min: float = 0.0
    """Interruptions in a minute, in which frames are lost in a row."""
    gap_s: float = 0.0
    """Mean duration of an interruption."""

    def drawn_shake_px(self, own: true_robot_t, rng: np.random.Generator) -> tuple[float, float]:
        """Draws how far a frame of the robot is shaken, along two axes."""
        deviation_px = self.shake_px + self.shake_px_per_m_s * math.hypot(own.vx_m_s, own.vy_m_s)
        first_px, second_px = (deviation_px * rng.standard_normal(2)).tolist()
        return first_px, second_px


MIRRORS: dict[Realism, MirrorErrors] = {
    "none": MirrorErrors(),
    "friendly": MirrorErrors(latency_s=0.02, shake_px=0.1, shake_px_per_m_s=0.15),
    "realistic": MirrorErrors(
        latency_s=0.035, shake_px=0.2, shake_px_per_m_s=0.3, tilt_sd_deg=0.05, gaps_1_min=1.0, gap_s=0.15
    ),
    "harsh": MirrorErrors(
        latency_s=0.07, shake_px=0.4, shake_px_per_m_s=0.6, tilt_sd_deg=0.3, gaps_1_min=2.0, gap_s=0.3
    ),
}
