"""Possible poses of a lost robot, followed until one hypothesis clearly explains the frames best."""

from dataclasses import dataclass

import numpy as np

from procs.localization.pose_filter import moved
from procs.model.frames import Floats, rotation

_MEMORY = 0.85  # weight of a hypothesis' mean score after ...
_MEMORY_S = 0.08  # ... this time
_MOST = 8  # most hypotheses
_SAME_M, _SAME_RAD = 0.5, 0.3  # two poses closer than both limits are the same
_LEAST_FRAMES = 3  # least number of frames for a decision
_OLD_ENOUGH_S = 0.38  # least age for a decision
_CLEAR_LEAD = 0.15  # least lead over the next best hypothesis, in score, for an early decision
_PATIENT_LEAD = 0.04  # the same for a late decision
_PATIENCE_S = 2.3  # age at which a decision counts as late
_STEADY_LEAD = 0.008  # a smaller lead suffices if one hypothesis keeps it in all frames ...
_STEADY_S = 3.0  # ... of this time: beside a touch line, places half a field apart differ in few points only


@dataclass
class Hypothesis:
    """A possible pose with the mean score of its matches."""

    pose: Floats
    """(3): x, y (m), heading (rad), world frame."""
    score: float
    frames: int = 1
    """Number of frames with a match."""
    newest: float = 0.0
    """Score in the newest frame."""
    age_s: float = 0.0
    led_s: float = 0.0
    """Time for which it has led steadily."""


class Hypotheses:
    """Hypotheses of a lost robot: moved by odometry, scored in each frame, joined when they meet."""

    def __init__(self) -> None:
        self.known: list[Hypothesis] = []
        """The hypotheses, best first."""

    def clear(self) -> None:
        """Forgets all hypotheses."""
        self.known = []

    def predict(self, ahead_m: float, left_m: float, turn_rad: float) -> None:
        """Moves the hypotheses with the robot by its odometry: a way in its former frame, and a turn."""
        for each in self.known:
            way_m = rotation(float(each.pose[2]) + turn_rad / 2) @ (ahead_m, left_m)
            each.pose = moved(each.pose, way_m, turn_rad)

    def starts(self, others: Floats) -> Floats:
        """Returns start poses (k, 3) for this frame's match: the hypotheses, then `others` (n, 3)."""
        return np.vstack([each.pose for each in self.known] + [others])

    def update(self, poses: Floats, scores: Floats, interval_s: float) -> None:
        """Takes poses (k, 3) and scores (k) of the matches from `starts`, and the time since the last frame."""
        count, memory = len(self.known), _MEMORY ** (interval_s / _MEMORY_S)
        for each, pose, score in zip(self.known, poses, scores, strict=False):
            each.pose = pose
            each.newest = float(score)
            each.score = memory * each.score + (1 - memory) * each.newest
            each.frames += 1
            each.age_s += interval_s
        news = zip(poses[count:], scores[count:], strict=True)
        found = [Hypothesis(pose, float(score), newest=float(score)) for pose, score in news]
        oldest_first = sorted(self.known, key=lambda each: (-each.age_s, -each.frames, -each.score)) + found
        kept: list[Hypothesis] = []
        for each in oldest_first:
            if not any(_same(each.pose, other.pose) for other in kept):
                kept.append(each)
        self.known = sorted(kept, key=lambda each: -each.score)[:_MOST]
        for place, each in enumerate(self.known):
            each.led_s = each.led_s + interval_s if place == 0 and self._lead >= _STEADY_LEAD else 0.0

    def decided(self, good_score: float) -> Hypothesis | None:
        """Returns the best hypothesis if it scores `good_score`, is old enough, and leads clearly or for long.

        A small lead has to show in the newest frame, too: of a robot that was set down elsewhere while it was lost, the
        mean scores tell of the former place.
        """
        best = self.known[0] if self.known else None
        if best is None or best.score < good_score or best.frames < _LEAST_FRAMES or best.age_s < _OLD_ENOUGH_S:
            return None
        if self._lead > _CLEAR_LEAD:
            return best
        late = best.led_s >= _STEADY_S or (best.age_s >= _PATIENCE_S and self._lead > _PATIENT_LEAD)
        leads = all(best.newest - each.newest >= _STEADY_LEAD for each in self.known[1:])
        return best if late and leads else None

    @property
    def _lead(self) -> float:
        """Score by which the best hypothesis leads over the next best."""
        return self.known[0].score - (self.known[1].score if len(self.known) > 1 else 0.0)


def _same(one: Floats, other: Floats) -> bool:
    """Returns whether two poses (3) are so close that they count as one hypothesis."""
    turn_rad = np.remainder(one[2] - other[2] + np.pi, 2 * np.pi) - np.pi
    return bool(np.hypot(*(one[:2] - other[:2])) < _SAME_M and abs(turn_rad) < _SAME_RAD)
