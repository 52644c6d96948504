"""Knows where a robot is on the field, from white points, odometry and compass, and notices when it does not.

While the robot is localized, each frame's points are matched from the predicted pose, and the match corrects the
filter. The whole field is searched every now and then; a place that explains the points clearly better, several
times in a row, means that the robot was carried away. While it is lost, hypotheses from that search are followed until
one is ahead. The compass is never averaged into the heading, because it drifts; it tells the two halves of the
symmetric field apart and bounds the heading.
"""

from dataclasses import dataclass

import numpy as np

from procs.localization.global_search import global_search
from procs.localization.hypotheses import Hypotheses
from procs.localization.line_map import LineMap
from procs.localization.line_matching import LinePoints, Matches, match
from procs.localization.pose_filter import PoseFilter
from procs.model.frames import Floats, wrap

_LOST_DEVIATIONS = (5.0, 5.0, 0.3)  # m, m, rad
_FOUND_DEVIATIONS = (0.1, 0.1, 0.05)
_FRAME_STANDING = np.array((0.006, 0.006, 0.002))  # m, m, rad: error that all points of a frame share: calibration, and
_FRAME_PER_M_S = np.array((0.02, 0.02, 0.001))  # the mirror that shakes more the faster the robot drives
_COMPASS_ERRORS_RAD = (0.0, -0.12, 0.12, -0.24, 0.24)  # tried one after the other while searching
_COMPASS_MEMORY = 0.998  # of the compass' offset from frame to frame: so slow that a robot that is carried away learns
_COMPASS_FORGETS = 0.99  # little that is wrong before it notices; and what it learnt fades while it searches


@dataclass(frozen=True)
class LocalizerSettings:
    """What a self-localizer can be told."""

    reach_m: float = 7.0
    points: int = 100
    least_points: int = 8
    search_points: int = 40
    search_period: int = 10
    """Frames from one look over the whole field to the next while localized."""
    lost_score: float = 0.4
    good_score: float = 0.5
    rival_lead: float = 0.12
    rivals: int = 3
    compass_limit_rad: float = 0.6
    correlation: float = 4.0
    """Points that share one error; the match's covariance is that many times the one of independent points."""


@dataclass(frozen=True)
class Motion:
    """From the last frame to this one, by odometry and gyro, in the robot's frame."""

    ahead_m: float
    left_m: float
    turn_rad: float
    speed_m_s: float


class SelfLocalizer:
    """Keeps the pose; `update` once a frame."""

    def __init__(self, lines: LineMap, settings: LocalizerSettings, start: Floats | None = None) -> None:
        """`start` is the pose (3) from which the robot is known to begin, within some 0.3 m."""
        self._lines = lines
        self._settings = settings
        self._search = global_search(lines, settings.reach_m)
        self._hypotheses = Hypotheses()
        self._filter = PoseFilter(np.zeros(3) if start is None else start, _LOST_DEVIATIONS)
        self.localized = False
        self.score = 0.0
        """Recent mean of how well the points lie on lines: 1 is perfect."""
        self.compass_offset_rad = 0.0
        """How much the compass says too much, learnt while localized."""
        self._rivals = 0
        self._frames = 0
        if start is not None:
            self._found(start, (0.3, 0.3, 0.1), settings.good_score)

    @property
    def pose(self) -> Floats:
        """x, y (m), heading (rad) in the world frame; (3)."""
        return self._filter.pose

    @property
    def covariance(self) -> Floats:
        """(3, 3) of x, y, heading."""
        return self._filter.covariance

    def update(self, motion: Motion, compass_rad: float | None, x_m: Floats, y_m: Floats) -> None:
        """A frame: motion since the last, the compass' heading if it is known, and white points in the robot frame."""
        self._frames += 1
        points = LinePoints.chosen(x_m, y_m, self._settings.reach_m, self._settings.points)
        self._filter.predict(motion.ahead_m, motion.left_m, motion.turn_rad)
        self._hypotheses.predict(motion.ahead_m, motion.left_m, motion.turn_rad)
        if len(points) < self._settings.least_points:
            return
        if self.localized:
            self._track(points, compass_rad, motion.speed_m_s)
        elif compass_rad is not None:
            self._seek(points, compass_rad - self.compass_offset_rad)

    def _track(self, points: LinePoints, compass_rad: float | None, speed_m_s: float) -> None:
        settings = self._settings
        found = match(self._lines, points, self.pose[None])
        self.score += 0.1 * (float(found.scores[0]) - self.score)
        if found.scores[0] > settings.lost_score:
            self._filter.correct(found.poses[0], self._match_covariance(found, speed_m_s))
        if compass_rad is not None:
            deviation_rad = wrap(compass_rad - self.compass_offset_rad - float(self.pose[2]))
            self.compass_offset_rad += (1 - _COMPASS_MEMORY) * deviation_rad
            if abs(deviation_rad) > settings.compass_limit_rad or self.score < settings.lost_score:
                self._lose()
            elif self._frames % settings.search_period == 0:
                self._look_for_rivals(points, compass_rad - self.compass_offset_rad)

    def _look_for_rivals(self, points: LinePoints, heading_rad: float) -> None:
        thin = points.thinned(self._settings.search_points)
        others = self._search.best(thin, np.array([heading_rad]), 3)
        found = match(self._lines, thin, np.vstack((self.pose, others)))
        ahead = float(found.scores[1:].max() - found.scores[0])
        self._rivals = self._rivals + 1 if ahead > self._settings.rival_lead else 0
        if self._rivals >= self._settings.rivals:
            self._lose()

    def _seek(self, points: LinePoints, heading_rad: float) -> None:
        self.compass_offset_rad *= _COMPASS_FORGETS
        thin = points.thinned(self._settings.search_points)
        turn_rad = _COMPASS_ERRORS_RAD[self._frames % len(_COMPASS_ERRORS_RAD)]
        others = self._search.best(thin, np.array([heading_rad + turn_rad]), 4)
        found = match(self._lines, thin, self._hypotheses.starts(others))
        turned_rad = np.remainder(found.poses[:, 2] - heading_rad + np.pi, 2 * np.pi) - np.pi
        scores = np.where(np.abs(turned_rad) < self._settings.compass_limit_rad, found.scores, 0.0)
        self._hypotheses.update(found.poses, scores)
        best = self._hypotheses.known[0]
        self._filter = PoseFilter(best.pose, _LOST_DEVIATIONS)
        decided = self._hypotheses.decided(self._settings.good_score)
        if decided is not None:
            self._found(decided.pose, _FOUND_DEVIATIONS, decided.score)

    def _match_covariance(self, found: Matches, speed_m_s: float) -> Floats:
        shared = np.square(_FRAME_STANDING + speed_m_s * _FRAME_PER_M_S)
        weak = np.diag((1.0, 1.0, 1.0))  # so that a direction without lines has a finite, large variance
        return np.asarray(self._settings.correlation * np.linalg.inv(found.information[0] + weak) + np.diag(shared))

    def _found(self, pose: Floats, deviations: tuple[float, float, float], score: float) -> None:
        self._filter = PoseFilter(pose, deviations)
        self.localized = True
        self.score = score
        self._rivals = 0
        self._hypotheses.clear()

    def _lose(self) -> None:
        self.localized = False
        self._hypotheses.clear()
        self._filter = PoseFilter(self.pose, _LOST_DEVIATIONS)
