"""Bursts in which a sensor delivers nothing: a loose cable, a camera that hangs."""

import math

import numpy as np

from procs.model.units import US_PER_S


class Gaps:
    """Interruptions of one sensor, in any order of calls the same for the same `rng`."""

    def __init__(self, rng: np.random.Generator) -> None:
        self._rng = rng
        self._before_us = -1
        self._back_us = 0

    def blind(self, now_us: int, gaps_1_min: float, gap_s: float) -> bool:
        """Returns whether the sensor delivers nothing now; call it once for each frame.

        Args:
            now_us: logical time, in µs.
            gaps_1_min: interruptions in a minute.
            gap_s: mean duration of an interruption, in s; durations are distributed exponentially.
        """
        passed_s = 0.0 if self._before_us < 0 else (now_us - self._before_us) / US_PER_S
        self._before_us = now_us
        luck, length = self._rng.random(2).tolist()
        if luck < -math.expm1(-gaps_1_min * passed_s / 60):
            self._back_us = max(self._back_us, now_us + round(-gap_s * math.log1p(-length) * US_PER_S))
        return now_us < self._back_us
