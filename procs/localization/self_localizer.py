"""Localizes a robot on the field from white points, odometry and compass, and notices when it is lost.

A localized robot matches the points of each frame, starting from the predicted pose, and the match corrects the filter.
From time to time it searches the whole field. If another place explains the points clearly better several times in a
row, the robot was carried away and is lost.

A lost robot follows hypotheses from searches of the whole field until one of them leads.

The compass distinguishes the two halves of the symmetric field and bounds the heading. It drifts, so it is never
averaged into the heading. Without a compass a lost robot stays lost, because the field looks the same from both halves.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from procs.localization.global_search import global_search
from procs.localization.hypotheses import Hypotheses, Hypothesis
from procs.localization.line_map import LineMap
from procs.localization.line_matching import LinePoints, Matches, match
from procs.localization.pose_filter import PoseFilter
from procs.model.expected_errors import EXPECTED, ExpectedErrors
from procs.model.frames import Floats
from procs.model.geometry import wrap_rad

_LOST_DEVIATIONS = (5.0, 5.0, 0.3)  # m, m, rad: of the pose of a lost robot
_FOUND_DEVIATIONS = (0.1, 0.1, 0.05)  # m, m, rad: of a pose that has just been found
_START_DEVIATIONS = (0.3, 0.3, 0.1)  # m, m, rad: of a start that the settings state
_COMPASS_ERRORS_RAD = (0.0, -0.12, 0.12, -0.24, 0.24)  # errors of the compass that a search tries in turn
_ALL_AROUND_RAD = np.linspace(-math.pi, math.pi, 24, endpoint=False)  # turns that a search without a compass tries
_COMPASS_MEMORY_S = 25.0  # time constant of the compass offset: so slow that a carried robot learns little wrong
_COMPASS_FORGETS_S = 5.0  # time constant with which the offset fades while the robot searches
_PLACES, _MANY_PLACES = 4, 16  # that a frame of a search adds; many in a long search, since places ...
_LONG_S = 1.5  # ... along a touch line hardly differ; before a small lead decides
_CONTRADICTIONS = 2  # frames in a row in which the compass contradicts a pose that fits: one wrong reading is no proof
_AS_USUAL = 0.9  # share of its mean score with which a pose fits as before; a robot that was carried away fits worse
_SCORE_MEMORY_S = 0.5  # time constant of the mean score


@dataclass(frozen=True)
class LocalizerSettings:
    """Settings of a self-localizer."""

    reach_m: float = 7.0
    """Points further away are not used."""
    points: int = 100
    """Most points of a frame that are used."""
    least_points: int = 8
    """Frames with fewer points are not used."""
    search_points: int = 40
    """Most points that a search of the whole field uses."""
    search_period_s: float = 0.5
    """Time from one search of the whole field to the next while localized."""
    lost_score: float = 0.4
    """The pose is given up when the mean score falls below this; 1 is a perfect fit."""
    good_score: float = 0.5
    """A lost robot accepts a pose only with at least this mean score."""
    rival_lead: float = 0.12
    """Another place counts as a rival of the pose if its score is higher by more than this."""
    rivals: int = 3
    """The pose is given up after so many searches in a row with a rival."""
    compass_limit_rad: float = 0.6
    """A heading is wrong if it differs by more than this from the compass without its offset."""
    correlation: float = 4.0
    """Number of points that share one error; the covariance of a match is larger by this factor."""
    errors: ExpectedErrors = EXPECTED["realistic"]
    """Errors of the camera."""


@dataclass(frozen=True)
class Motion:
    """Motion since the last update, by odometry and gyro, in the robot's frame."""

    ahead_m: float
    left_m: float
    turn_rad: float
    speed_m_s: float
    turn_sd_rad: float = 0.0
    """Deviation of a turn by the wheels, which lasts from motion to motion; 0 with a gyro."""


class SelfLocalizer:
    """Estimate of the pose; call `update` once a tick."""

    def __init__(self, lines: LineMap, settings: LocalizerSettings, start: Floats | None = None) -> None:
        """Starts lost, or at a pose `start` (3) that is right within some 0.3 m."""
        self._lines = lines
        self._settings = settings
        self._search = global_search(lines, settings.reach_m)
        self._hypotheses = Hypotheses()
        self._filter = PoseFilter(np.zeros(3) if start is None else start, _LOST_DEVIATIONS)
        self.localized = False
        self.score = 0.0
        """Recent mean score of the matches: 1 if all points lie on lines."""
        self.compass_offset_rad = 0.0
        """Compass reading minus heading, learnt while localized."""
        self._rivals = 0  # searches in a row with a better place
        self._contradictions = 0  # frames in a row in which the compass contradicts the pose
        self.searches = 0
        """Number of frames in which the robot was lost and searched."""
        self._sought_s = 0.0  # time of this search
        self._since_frame_s = 0.0
        self._since_search_s = 0.0
        if start is not None:
            self._found(start, _START_DEVIATIONS, settings.good_score)

    @property
    def pose(self) -> Floats:
        """(3): x, y (m), heading (rad), world frame."""
        return self._filter.pose

    @property
    def places(self) -> Sequence[Hypothesis]:
        """Places where the robot may be, best first; empty while it is localized."""
        return self._hypotheses.known

    @property
    def covariance(self) -> Floats:
        """(3, 3) of x, y, heading, including the lasting errors."""
        errors = self._settings.errors
        if errors.lasting_m == errors.lasting_rad == 0.0:
            return self._filter.covariance
        return self._filter.covariance + _diagonal(errors.lasting_m, errors.lasting_rad)

    def change(self, lines: LineMap, settings: LocalizerSettings) -> None:
        """Takes new lines and settings; keeps the pose and everything learnt."""
        self._lines, self._settings = lines, settings
        self._search = global_search(lines, settings.reach_m)

    def update(
        self,
        motion: Motion,
        compass_rad: float | None,
        x_m: Floats,
        y_m: Floats,
        duration_s: float,
        moved: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        """Takes the motion since the last update and the sensors' readings.

        Args:
            motion: by odometry and gyro.
            compass_rad: heading by the compass; None if it is not known.
            x_m: white points (n) of a new frame, robot frame; empty without a new frame.
            y_m: see x_m.
            duration_s: time since the last update.
            moved: standard deviations in m and rad of the motion that moved the points since an old exposure.
        """
        self._since_frame_s += duration_s
        self._since_search_s += duration_s
        scale_sd = self._settings.errors.wheel_scale_sd
        way_m = motion.ahead_m, motion.left_m
        self._filter.predict(*way_m, motion.turn_rad, duration_s, scale_sd, motion.turn_sd_rad)
        self._hypotheses.predict(motion.ahead_m, motion.left_m, motion.turn_rad)
        if len(x_m) < self._settings.least_points:
            return
        points = LinePoints.chosen(x_m, y_m, self._settings.reach_m, self._settings.points)
        if len(points) < self._settings.least_points:
            return
        interval_s, self._since_frame_s = self._since_frame_s, 0.0
        if self.localized:
            self._track(points, compass_rad, self._shared(motion.speed_m_s, moved), interval_s)
        elif compass_rad is not None:
            self._seek(points, compass_rad - self.compass_offset_rad, interval_s)

    def _track(self, points: LinePoints, compass_rad: float | None, shared: Floats, interval_s: float) -> None:
        """Corrects the pose with the points; gives it up if points or compass contradict it."""
        settings = self._settings
        found, usual_score = match(self._lines, points, self.pose[None]), self.score
        self.score += _share(interval_s, _SCORE_MEMORY_S) * (float(found.scores[0]) - self.score)
        if found.scores[0] > settings.lost_score:
            self._filter.correct(found.poses[0], self._match_covariance(found, shared), interval_s)
        headings_rad = self.pose[2] + _ALL_AROUND_RAD
        if compass_rad is not None:
            deviation_rad = wrap_rad(compass_rad - self.compass_offset_rad - float(self.pose[2]))
            self.compass_offset_rad += _share(interval_s, _COMPASS_MEMORY_S) * deviation_rad
            contradicted = abs(deviation_rad) > settings.compass_limit_rad
            fits = found.scores[0] >= max(settings.good_score, _AS_USUAL * usual_score)
            counts = 1 if fits else _CONTRADICTIONS
            self._contradictions = self._contradictions + counts if contradicted else 0
            headings_rad = np.array([compass_rad - self.compass_offset_rad])
        if self._contradictions >= _CONTRADICTIONS or self.score < settings.lost_score:
            self._lose()
        elif self._since_search_s >= settings.search_period_s:
            self._since_search_s = 0.0
            self._look_for_rivals(points, headings_rad)

    def _look_for_rivals(self, points: LinePoints, headings_rad: Floats) -> None:
        """Searches the whole field; gives the pose up once another place was clearly better several times in a row."""
        thin = points.thinned(self._settings.search_points)
        others = self._search.best(thin, headings_rad, 3)
        found = match(self._lines, thin, np.vstack((self.pose, others)))
        ahead = float(found.scores[1:].max() - found.scores[0])
        self._rivals = self._rivals + 1 if ahead > self._settings.rival_lead else 0
        if self._rivals >= self._settings.rivals:
            self._lose()

    def _seek(self, points: LinePoints, heading_rad: float, interval_s: float) -> None:
        """Updates the hypotheses of a lost robot with points and compass; takes the pose of one that leads clearly."""
        self.compass_offset_rad *= 1.0 - _share(interval_s, _COMPASS_FORGETS_S)
        thin = points.thinned(self._settings.search_points)
        turn_rad = _COMPASS_ERRORS_RAD[self.searches % len(_COMPASS_ERRORS_RAD)]
        self.searches += 1
        self._sought_s += interval_s
        is_long = self._sought_s >= _LONG_S
        others = self._search.best(thin, np.array([heading_rad + turn_rad]), _MANY_PLACES if is_long else _PLACES)
        if is_long and self._hypotheses.known:
            others = np.vstack((self._half_a_field_from(self._hypotheses.known[0].pose), others))
        found = match(self._lines, thin, self._hypotheses.starts(others))
        turned_rad = np.remainder(found.poses[:, 2] - heading_rad + np.pi, 2 * np.pi) - np.pi
        scores = np.where(np.abs(turned_rad) < self._settings.compass_limit_rad, found.scores, 0.0)
        self._hypotheses.update(found.poses, scores, interval_s)
        best = self._hypotheses.known[0]
        self._filter = PoseFilter(np.array((*best.pose[:2], wrap_rad(float(best.pose[2])))), _LOST_DEVIATIONS)
        decided = self._hypotheses.decided(self._settings.good_score)
        if decided is not None:
            self._found(decided.pose, _FOUND_DEVIATIONS, decided.score)

    def _half_a_field_from(self, pose: Floats) -> Floats:
        """Returns the pose (3) in the other half that looks most like this one: halfway and goal line change roles."""
        return pose - (math.copysign(self._lines.field.half_length_m, pose[0]), 0.0, 0.0)

    def _shared(self, speed_m_s: float, moved: tuple[float, float]) -> Floats:
        """Returns the covariance (3, 3) of the errors that all points of a frame share."""
        errors = self._settings.errors
        shared = _diagonal(
            errors.frame_m + speed_m_s * errors.frame_s, errors.frame_rad + speed_m_s * errors.frame_rad_s_m
        )
        return shared + _diagonal(*moved)

    def _match_covariance(self, found: Matches, shared: Floats) -> Floats:
        weak = np.eye(3)  # gives a direction without lines a finite, large variance
        return np.asarray(self._settings.correlation * np.linalg.inv(found.information[0] + weak) + shared)

    def _found(self, pose: Floats, deviations: tuple[float, float, float], score: float) -> None:
        self._filter = PoseFilter(pose, deviations)
        self.localized = True
        self.score = score
        self._rivals = self._contradictions = 0
        self._since_search_s = self._sought_s = 0.0
        self._hypotheses.clear()

    def _lose(self) -> None:
        self.localized = False
        self._hypotheses.clear()
        self._filter = PoseFilter(self.pose, _LOST_DEVIATIONS)


def _share(duration_s: float, memory_s: float) -> float:
    """Returns the weight of a new value in a running mean with the time constant `memory_s`."""
    return -math.expm1(-duration_s / memory_s)


def _diagonal(deviation_m: float, deviation_rad: float) -> Floats:
    """Returns the covariance (3, 3) of a pose with independent errors."""
    return np.diag(np.square((deviation_m, deviation_m, deviation_rad)))
