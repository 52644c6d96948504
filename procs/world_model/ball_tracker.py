"""One ball out of what several robots see, with rules for when they disagree.

Order of the sources:

1. The light barrier in the robot's own mouth: while the ball is held it is there, and other sightings are not asked.
2. The robot's own camera. Team mates' sightings that fit are averaged in, each by its covariance.
3. Team mates, when the robot does not see the ball itself; among them the one who sees it more precisely.

A sighting that does not fit the track is dropped while a better source confirms the track. Otherwise two such
sightings that fit each other begin a new track: the ball was kicked, bounced or was put somewhere else.
"""

from dataclasses import dataclass

import numpy as np

from procs.model.frames import Floats
from procs.world_model.ball_filter import BallFilter

_GATE = 13.8  # 99.9 % of true sightings are nearer; chi-square, 2 degrees of freedom
_CONFIRMED_S = 0.25
_SECOND_SIGHT_S = 0.3
_FASTEST_M_S = 13.0
_OWN_BONUS = 4.0  # one's own eyes count as if they were that much better than a mate's of the same variance
_OBSERVER_S = 0.5


@dataclass(frozen=True)
class Sighting:
    """Where a robot saw the ball: world frame, `age_s` ago."""

    robot: str
    own: bool
    position_m: Floats
    covariance_m2: Floats
    age_s: float = 0.0

    @property
    def weakness(self) -> float:
        """The smaller, the more this source is believed."""
        return float(np.trace(self.covariance_m2)) / (_OWN_BONUS if self.own else 1.0)


class BallTracker:
    """Keeps the track; `advance`, then the sightings of the frame, own ones first."""

    def __init__(self) -> None:
        self._rolling_m_s2 = 0.0
        self._track: BallFilter | None = None
        self._now_s = 0.0
        self._doubts: list[tuple[float, Sighting]] = []
        self._confirmed: dict[str, tuple[float, float]] = {}
        """Robot to (time of its newest sighting in the track, weakness)."""
        self._seen_s = -np.inf
        self._held_s = -np.inf

    @property
    def known(self) -> bool:
        """Whether the ball was seen within the time-out."""
        return self._track is not None

    @property
    def track(self) -> BallFilter:
        """The ball's filter; only while it is known."""
        assert self._track is not None
        return self._track

    @property
    def age_s(self) -> float:
        """Since anybody saw the ball."""
        return self._now_s - self._seen_s

    @property
    def observers(self) -> int:
        """Robots that contributed in the last half second."""
        return sum(self._now_s - seen_s < _OBSERVER_S for seen_s, _ in self._confirmed.values())

    def advance(self, duration_s: float, timeout_s: float, rolling_m_s2: float) -> None:
        """Time goes on. The ball is forgotten after the time-out; rolling, it slows down that much."""
        self._rolling_m_s2 = rolling_m_s2
        self._now_s += duration_s
        self._doubts = [doubt for doubt in self._doubts if self._now_s - doubt[0] <= _SECOND_SIGHT_S]
        if self._track is not None:
            self._track.predict(duration_s, rolling_m_s2)
            if self.age_s > timeout_s:
                self.forget()

    def see(self, sighting: Sighting) -> bool:
        """Takes a sighting in; false if it does not fit."""
        if self._now_s == self._held_s:
            return False
        if self._track is None:
            self._begin(sighting)
            return True
        if self._track.surprise(sighting.position_m, sighting.covariance_m2, sighting.age_s) <= _GATE:
            self._track.see(sighting.position_m, sighting.covariance_m2, sighting.age_s)
            self._confirm(sighting)
            return True
        if self._overruled(sighting):
            return False
        return self._doubt(sighting)

    def hold(self, robot: str, state: Floats) -> None:
        """The robot holds the ball: it is at this place with this velocity (4)."""
        position_m = state[:2]
        if self._track is None or np.hypot(*(self._track.state[:2] - position_m)) > 0.3:
            self._track = BallFilter(position_m, np.eye(2) * 0.05**2)
        self._track.hold(state, (0.02, 0.1))
        self._confirmed = {robot: (self._now_s, 0.0)}
        self._seen_s = self._held_s = self._now_s
        self._doubts = []

    def kick(self, heading_rad: float) -> None:
        """The robot itself kicked the ball that way; said before the time goes on in which the ball flies."""
        if self._track is not None:
            self._track.kick(heading_rad)
        self._confirmed = {}

    def forget(self) -> None:
        """Drops the track and everything that was seen."""
        self._track = None
        self._doubts = []
        self._confirmed = {}

    def _overruled(self, sighting: Sighting) -> bool:
        return any(
            robot != sighting.robot and self._now_s - seen_s <= _CONFIRMED_S and weakness < sighting.weakness
            for robot, (seen_s, weakness) in self._confirmed.items()
        )

    def _doubt(self, sighting: Sighting) -> bool:
        """Keeps a sighting that does not fit; with a second one that fits it, they are the track."""
        seen_s = self._now_s - sighting.age_s
        for other_s, other in reversed(self._doubts):
            between_s = seen_s - other_s
            spread_m = 3 * np.sqrt(np.trace(sighting.covariance_m2 + other.covariance_m2))
            if np.hypot(*(sighting.position_m - other.position_m)) <= _FASTEST_M_S * abs(between_s) + spread_m:
                self._confirmed = {}
                if between_s > 0:
                    self._begin(other, sighting, between_s)
                else:
                    self._begin(sighting)
                return True
        self._doubts.append((seen_s, sighting))
        return False

    def _begin(self, first: Sighting, second: Sighting | None = None, between_s: float = 0.0) -> None:
        """A new track, from one sighting or from two that tell the velocity too."""
        track = self._track = BallFilter(first.position_m, first.covariance_m2)
        last = first
        if second is not None:
            track.predict(between_s, self._rolling_m_s2)
            track.see(second.position_m, second.covariance_m2)
            last = second
        track.predict(last.age_s, self._rolling_m_s2)
        self._doubts = []
        self._confirm(last)

    def _confirm(self, sighting: Sighting) -> None:
        self._confirmed[sighting.robot] = (self._now_s - sighting.age_s, sighting.weakness)
        self._seen_s = max(self._seen_s, self._now_s - sighting.age_s)
