"""Monte Carlo localization with a fixed number of particles, the baseline of the robots' own localization.

As the omni_localizer of Fawkes in 2008: 200 particles, an odometry error of 20 % of the way, white points that are
likely near a line. Where the points become less likely, random particles take the place of some (Thrun, Burgard and
Fox, "Probabilistic Robotics", table 8.3); a compass tells the halves of the field apart.
"""

import numpy as np

from procs.localization.line_map import LineMap
from procs.model.frames import Floats

_COUNT = 200
_WAY_ERROR, _TURN_ERROR = 0.2, 0.1  # share of the way and of the turn
_STANDING = np.array((0.01, 0.01, 0.01))  # m, m, rad: spread of particles in each step
_LINE_M = 0.25  # deviation of a white point from its line
_CLUTTER = 0.1  # share of white points that belong to no line
_INDEPENDENT = 20  # points of a frame count as so many independent ones
_COMPASS_RAD = 0.2
_SLOW, _FAST = 0.05, 0.3  # weights of a frame in the two running means of the likelihood
_LEAST_NEW = 0.1  # share of random particles: a wrong place may be believed
_TOGETHER_M = 0.5


class Particles:
    """Particles (n, 3) of x, y (m) and heading (rad), world frame; the same seed gives the same particles."""

    def __init__(self, lines: LineMap, rng: np.random.Generator) -> None:
        self._lines, self._rng = lines, rng
        self._slow = self._fast = 0.0
        self._poses = self._scattered(_COUNT, None)
        self._best = self._poses[0]

    def move(self, ahead_m: float, left_m: float, turn_rad: float) -> None:
        """Moves all particles by the odometry, each with an error of its own."""
        way_m = np.array((ahead_m, left_m))
        drawn = self._rng.standard_normal((_COUNT, 3))
        ways_m = way_m + drawn[:, :2] * (_WAY_ERROR * np.hypot(*way_m))
        turns_rad = turn_rad + drawn[:, 2] * (_TURN_ERROR * abs(turn_rad))
        middles_rad = self._poses[:, 2] + turns_rad / 2
        cosine, sine = np.cos(middles_rad), np.sin(middles_rad)
        moved = np.empty_like(self._poses)
        moved[:, 0] = self._poses[:, 0] + cosine * ways_m[:, 0] - sine * ways_m[:, 1]
        moved[:, 1] = self._poses[:, 1] + sine * ways_m[:, 0] + cosine * ways_m[:, 1]
        moved[:, 2] = self._poses[:, 2] + turns_rad
        self._poses = moved

    def see(self, x_m: Floats, y_m: Floats, compass_rad: float | None) -> None:
        """Draws new particles by the likelihood of white points (n each), robot frame, and of the compass."""
        if not self._slow:
            self._poses = self._scattered(_COUNT, compass_rad)
        logs = self._log_likelihoods(x_m, y_m)
        likely = float(np.exp(logs).mean())
        self._slow += _SLOW * (likely - self._slow)
        self._fast += _FAST * (likely - self._fast)
        logs *= _INDEPENDENT
        if compass_rad is not None:
            away_rad = np.remainder(compass_rad - self._poses[:, 2] + np.pi, 2 * np.pi) - np.pi
            logs -= (away_rad / _COMPASS_RAD) ** 2 / 2
        weights = np.exp(logs - logs.max())
        self._best = self._poses[int(weights.argmax())]
        sums = np.cumsum(weights / weights.sum())
        drawn = np.searchsorted(sums, (np.arange(_COUNT) + self._rng.random()) / _COUNT)
        self._poses = self._poses[np.minimum(drawn, _COUNT - 1)]
        self._poses = self._poses + _STANDING * self._rng.standard_normal((_COUNT, 3))
        new = self._rng.random(_COUNT) < max(_LEAST_NEW, 1.0 - self._fast / self._slow)
        self._poses[new] = self._scattered(int(new.sum()), compass_rad)

    def estimate(self) -> tuple[Floats, Floats, bool]:
        """Returns mean (3) and covariance (3, 3) of the particles near the best, and whether those are the most."""
        near = np.hypot(*(self._poses[:, :2] - self._best[:2]).T) < _TOGETHER_M
        apart = self._poses[near] - self._best
        if not len(apart):
            return self._best, np.eye(3), False
        apart[:, 2] = np.remainder(apart[:, 2] + np.pi, 2 * np.pi) - np.pi
        mean = apart.mean(axis=0)
        covariance = (apart - mean).T @ (apart - mean) / len(apart) + np.diag(_STANDING**2)
        return self._best + mean, covariance, bool(near.sum() > _COUNT / 2)

    def _log_likelihoods(self, x_m: Floats, y_m: Floats) -> Floats:
        """Returns the mean logarithm (n) of a point's likelihood for each particle."""
        cosine, sine = np.cos(self._poses[:, 2, None]), np.sin(self._poses[:, 2, None])
        distances_m, _, _ = self._lines.look_up(
            self._poses[:, 0, None] + cosine * x_m - sine * y_m, self._poses[:, 1, None] + sine * x_m + cosine * y_m
        )
        on_line = np.exp(-((distances_m / _LINE_M) ** 2) / 2)
        return np.asarray(np.log(_CLUTTER + (1.0 - _CLUTTER) * on_line).mean(axis=1))

    def _scattered(self, count: int, heading_rad: float | None) -> Floats:
        field = self._lines.field
        places = self._rng.uniform(-1.0, 1.0, (count, 3)) * (field.half_length_m, field.half_width_m, np.pi)
        if heading_rad is not None:
            places[:, 2] = heading_rad + _COMPASS_RAD * self._rng.standard_normal(count)
        return places
