"""One ball from the sightings of several robots, with rules for sightings that contradict each other.

Order of the sources:

1. The light barrier in the robot's own mouth: while it holds the ball, other sightings do not count.
2. The robot's own camera. Mates' sightings that fit are fused, each by its covariance.
3. Mates, when the robot does not see the ball itself; among them the more precise.

A sighting that does not fit the track is dropped if a better source has confirmed the track since its exposure.
Otherwise it is kept as a doubt, until a better source confirms the track; two doubts that fit each other begin a new
track: the ball was kicked, bounced or was placed elsewhere.
"""

from dataclasses import dataclass, replace

import numpy as np

from procs.model.frames import Floats
from procs.world_model.ball_filter import BallFilter
from procs.world_model.seen import Seen

_SECOND_SIGHT_S = 0.3
_FASTEST_M_S = 13.0
_OWN_BONUS = 4.0  # factor by which the own camera counts as better than a mate's of the same variance
_OBSERVER_S = 0.5
_NOTICED_SHARE = 0.15  # a track whose velocity differs less from a kick's has noticed the kick
_HELD_M = 0.02  # deviation of a held ball's place in the mouth
_HELD_M_S = 0.1


@dataclass(frozen=True)
class Sighting:
    """Position of the ball as a robot saw it: world frame, captured `age_s` ago."""

    robot: str
    own: bool
    position_m: Floats
    covariance_m2: Floats
    age_s: float = 0.0

    @property
    def weakness(self) -> float:
        """Rank of the source: the smaller, the better."""
        return float(np.trace(self.covariance_m2)) / (_OWN_BONUS if self.own else 1.0)


class BallTracker:
    """Track of the ball: `advance` once a tick, then the sightings of the tick, own ones first."""

    def __init__(self) -> None:
        self._rolling_m_s2 = 0.0
        self._track: BallFilter | None = None
        self._now_s = 0.0
        self._doubts: list[tuple[float, Sighting]] = []
        self._confirmed: dict[str, tuple[float, float]] = {}
        """Robot to (exposure of its newest sighting in the track, weakness)."""
        self._seen_s = -np.inf
        self._held_s = -np.inf
        self._moved_s = -np.inf  # a known kick, or a ball in the own mouth: exposures before it tell nothing

    @property
    def known(self) -> bool:
        """True if the ball was seen within the time-out."""
        return self._track is not None

    @property
    def track(self) -> BallFilter:
        """Filter of a known ball.

        Raises:
            ValueError: the ball is not known.
        """
        if self._track is None:
            raise ValueError("the ball is not known; ask 'known' first")
        return self._track

    @property
    def age_s(self) -> float:
        """Time since the newest sighting."""
        return self._now_s - self._seen_s

    @property
    def observers(self) -> int:
        """Number of robots with a sighting in the last half second."""
        return sum(self._now_s - seen_s < _OBSERVER_S for seen_s, _ in self._confirmed.values())

    def advance(self, duration_s: float, timeout_s: float, rolling_m_s2: float, contact: bool = False) -> None:
        """Moves the track on by `duration_s`; forgets a ball without a sighting for `timeout_s`.

        `contact` says that a robot or a wall is near the ball.
        """
        self._rolling_m_s2 = rolling_m_s2
        self._now_s += duration_s
        self._doubts = [doubt for doubt in self._doubts if self._now_s - doubt[0] <= _SECOND_SIGHT_S]
        if self._track is not None:
            self._track.predict(duration_s, rolling_m_s2, contact)
            if self.age_s > timeout_s:
                self.forget()

    def see(self, sighting: Sighting) -> bool:
        """Takes a sighting; returns False if it does not fit."""
        if self._now_s == self._held_s or self._now_s - sighting.age_s < self._moved_s - 1e-6:
            return False
        if self._track is None:
            self._begin(sighting)
            return True
        if self._track.see(sighting.position_m, sighting.covariance_m2, sighting.age_s):
            self._confirm(sighting)
            return True
        if self._overruled(sighting):
            return False
        return self._doubt(sighting)

    def hold(self, robot: str, state: Floats, covariance: Floats) -> None:
        """Takes a ball in the own mouth.

        Args:
            robot: name of the robot.
            state: (4) of the ball: x, y, vx, vy, world frame.
            covariance: (4, 4) that the own pose and velocity add to it.
        """
        if self._track is None or np.hypot(*(self._track.state[:2] - state[:2])) > 0.3:
            self._track = BallFilter(state[:2], np.eye(2) * 0.05**2 + covariance[:2, :2])
        self._track.hold(state, covariance + np.diag(np.square((_HELD_M, _HELD_M, _HELD_M_S, _HELD_M_S))))
        self._confirmed = {robot: (self._now_s, 0.0)}
        self._seen_s = self._held_s = self._moved_s = self._now_s
        self._doubts = []

    def kick(self, velocity_m_s: Floats, age_s: float = 0.0, mouth: Seen = Seen.NOTHING) -> None:
        """Takes a kick that gave the ball a velocity; call it before `advance`.

        A kick of a mate that the track already shows changes nothing.

        Args:
            velocity_m_s: (2), world frame.
            age_s: time since the kick.
            mouth: place of the ball at the kick (0 or 1), if it is not the track's: the mouth of a mate.
        """
        if self._track is not None:
            surprise_m_s = np.hypot(*(self._track.state[2:] - velocity_m_s))
            if age_s and surprise_m_s < _NOTICED_SHARE * np.hypot(*velocity_m_s):
                return
        for position_m, covariance_m2 in zip(mouth.positions_m, mouth.covariances_m2, strict=True):
            self._track = BallFilter(position_m, covariance_m2)
            self._seen_s = max(self._seen_s, self._now_s - age_s)
        if self._track is not None:
            self._track.kick(velocity_m_s)
            self._track.predict(age_s, self._rolling_m_s2)
        self._moved_s = self._now_s - age_s
        self._confirmed = {}
        self._doubts = []

    def forget(self) -> None:
        """Drops the track and all sightings."""
        self._track = None
        self._doubts = []
        self._confirmed = {}

    def _overruled(self, sighting: Sighting) -> bool:
        """Returns whether a better source has confirmed the track since the sighting's exposure."""
        exposed_s = self._now_s - sighting.age_s
        return any(
            robot != sighting.robot and seen_s >= exposed_s - 1e-6 and weakness < sighting.weakness
            for robot, (seen_s, weakness) in self._confirmed.items()
        )

    def _doubt(self, sighting: Sighting) -> bool:
        """Keeps a sighting that does not fit; begins a new track from two that fit each other."""
        exposed_s = self._now_s - sighting.age_s
        for other_s, other in reversed(self._doubts):
            between_s = exposed_s - other_s
            spread_m = 3 * np.sqrt(np.trace(sighting.covariance_m2 + other.covariance_m2))
            if np.hypot(*(sighting.position_m - other.position_m)) <= _FASTEST_M_S * abs(between_s) + spread_m:
                self._confirmed = {}
                aged = replace(other, age_s=self._now_s - other_s)
                older, newer = (aged, sighting) if between_s > 0 else (sighting, aged)
                self._begin(older, newer, abs(between_s))
                return True
        self._doubts.append((exposed_s, sighting))
        return False

    def _begin(self, first: Sighting, second: Sighting | None = None, between_s: float = 0.0) -> None:
        """Begins a track from one sighting, or from two with `between_s` from the older to the newer exposure."""
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
        exposed_s = self._now_s - sighting.age_s
        self._confirmed[sighting.robot] = (exposed_s, sighting.weakness)
        self._seen_s = max(self._seen_s, exposed_s)
        self._doubts = [
            doubt for doubt in self._doubts if doubt[0] > exposed_s or doubt[1].weakness <= sighting.weakness
        ]
