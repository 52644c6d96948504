"""The ball in the newest frames of the own camera, which outweighs the claim of a mate to hold the ball."""

import math
from collections import deque
from collections.abc import Sequence

from procs.model.units import US_PER_S
from procs.world_model.frame_pace import FramePace
from procs.world_model.sighting import Sighting

_FRAMES = 2  # number of frames that have to agree; a single one may show another thing
_NEWEST_S = 0.4  # the newest frame counts for so long
_BETWEEN_S = 0.3  # longest time between the frames that have to agree; more if the camera is slower
_ELSEWHERE_M = 1.0  # the errors of two robots' places are smaller together


class OwnSights:
    """Decides whether the own camera sees the ball away from a mate that believes it holds the ball."""

    def __init__(self, fastest_m_s: float) -> None:
        """Begins without a frame; no ball exceeds the speed `fastest_m_s`."""
        self.fastest_m_s = fastest_m_s
        self._frames: deque[tuple[int, list[tuple[float, float]]]] = deque(maxlen=_FRAMES)
        self._pace = FramePace()

    @property
    def next_s(self) -> float:
        """Time after an exposure within which the next one comes; 0: not known."""
        return self._pace.next_s

    def note(self, exposed_us: int, sightings: Sequence[Sighting]) -> None:
        """Takes the candidates for the ball in a frame."""
        self._pace.note(exposed_us)
        self._frames.append((exposed_us, [(each.position_m[0], each.position_m[1]) for each in sightings]))

    def contradict(self, place_m: tuple[float, float], told_us: int, now_us: int) -> bool:
        """Returns whether the newest frames show the ball far from `place_m`, which a mate stated at `told_us`.

        A frame without a ball does not contradict: a robot may hide the ball.
        """
        if len(self._frames) < _FRAMES:
            return False
        first_us, newest_us = self._frames[0][0], self._frames[-1][0]
        between_s = (newest_us - first_us) / US_PER_S
        if now_us - newest_us > _NEWEST_S * US_PER_S or between_s > max(_BETWEEN_S, self._pace.next_s):
            return False
        return all(
            seen_m and self._is_far(place_m, seen_m, told_us - exposed_us) for exposed_us, seen_m in self._frames
        )

    def _is_far(self, place_m: tuple[float, float], seen_m: Sequence[tuple[float, float]], between_us: int) -> bool:
        reach_m = _ELSEWHERE_M + self.fastest_m_s * abs(between_us) / US_PER_S
        return all(math.dist(place_m, each) > reach_m for each in seen_m)
