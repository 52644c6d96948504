"""Frames of a camera: the time until the next one, and which have come before."""

from collections import deque
from itertools import pairwise

from procs.model.units import US_PER_S

_FRAMES = 4  # newest frames; the shortest time between two of them counts, as lost frames make others longer
_LATE = 1.4  # multiple of this time within which the next frame comes
_LONGEST_S = 1.0  # a camera that is silent for longer has no pace


class NewFrames:
    """Tells new frames from one that a driver publishes again, which would count twice."""

    def __init__(self) -> None:
        self._newest_us = 0

    def takes(self, capture_us: int) -> bool:
        """Takes a frame; returns whether it is new. A frame without a time of exposure, 0, always is."""
        known_us, self._newest_us = self._newest_us, capture_us
        return not capture_us or capture_us != known_us


class FramePace:
    """Learns the time between the frames of a camera from their exposures."""

    def __init__(self) -> None:
        self._exposures_us: deque[int] = deque(maxlen=_FRAMES)

    def note(self, exposed_us: int) -> None:
        """Takes the exposure of a new frame."""
        newest_us = self._exposures_us[-1] if self._exposures_us else exposed_us
        if not newest_us <= exposed_us <= newest_us + _LONGEST_S * US_PER_S:
            self._exposures_us.clear()
        self._exposures_us.append(exposed_us)

    @property
    def interval_s(self) -> float:
        """Time from one exposure to the next; 0: not known."""
        return self._interval_us / US_PER_S

    @property
    def next_s(self) -> float:
        """Time after an exposure within which the next one comes, give or take a lost frame; 0: not known."""
        return _LATE * self._interval_us / US_PER_S

    @property
    def _interval_us(self) -> int:
        return min((after - before for before, after in pairwise(self._exposures_us)), default=0)
