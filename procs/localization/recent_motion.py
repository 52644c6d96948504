"""Motion of a robot in the last 1.5 s, for points that were seen some ticks ago."""

from collections import deque
from typing import NamedTuple

import numpy as np

from procs.localization.self_localizer import Motion
from procs.model.frames import Floats, rotation

MEMORY_US = 1_500_000
"""Older motions are forgotten; no camera takes longer from the exposure to the points."""


class Way(NamedTuple):
    """Motion since an exposure, in the robot's frame at the exposure."""

    shift_m: Floats
    """(2): ahead and left."""
    turn_rad: float
    turn_sd_rad: float = 0.0
    """Deviation of turns by the wheels."""


class RecentMotion:
    """Memory of the motions between updates."""

    def __init__(self) -> None:
        self._steps: deque[tuple[int, int, Motion]] = deque()

    def add(self, from_us: int, to_us: int, motion: Motion) -> None:
        """Takes the motion between two times; `from_us` is the `to_us` of the call before."""
        self._steps.append((from_us, to_us, motion))
        while self._steps[0][1] < to_us - MEMORY_US:
            self._steps.popleft()

    def since(self, time_us: int) -> Way | None:
        """Returns the way from a time until now; None if the memory does not reach back to that time."""
        if not self._steps or time_us < self._steps[0][0]:
            return None
        shift_m, turn_rad, turn_sd_rad = np.zeros(2), 0.0, 0.0
        for from_us, to_us, motion in self._steps:
            if to_us <= time_us:
                continue
            share = min(1.0, (to_us - time_us) / (to_us - from_us))
            middle_rad = turn_rad + share * motion.turn_rad / 2
            shift_m = shift_m + rotation(middle_rad) @ (share * motion.ahead_m, share * motion.left_m)
            turn_rad += share * motion.turn_rad
            turn_sd_rad += share * motion.turn_sd_rad
        return Way(shift_m, turn_rad, turn_sd_rad)
