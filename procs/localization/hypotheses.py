"""Possible poses of a lost robot, followed until a hypothesis explains the frames clearly best."""

from dataclasses import dataclass, field

import numpy as np

from procs.localization.pose_filter import moved
from procs.model.frames import Floats, rotation

_MEMORY = 0.85  # of a hypothesis' mean score after ...
_MEMORY_S = 0.08  # ... this time
_MOST = 8  # hypotheses
_SAME_M, _SAME_RAD = 0.5, 0.3  # poses nearer to each other than both are the same
_LEAST_FRAMES = 3  # for a decision
_OLD_ENOUGH_S = 0.38  # age for a decision
_CLEAR_LEAD = 0.15  # over the next best, for a decision as early as that
_PATIENT_LEAD = 0.04  # for a late decision
_PATIENCE_S = 2.3  # age from which the lead may be as small as that


@dataclass
class Hypothesis:
    """A possible pose (3) with the mean score of its matches."""

    pose: Floats
    score: float
    frames: int = field(default=1)
    age_s: float = field(default=0.0)


class Hypotheses:
    """Hypotheses of a lost robot: followed by odometry, scored in each frame, joined when they meet; best first."""

    def __init__(self) -> None:
        self.known: list[Hypothesis] = []

    def clear(self) -> None:
        """Forgets all."""
        self.known = []

    def predict(self, ahead_m: float, left_m: float, turn_rad: float) -> None:
        """Moves the hypotheses with the robot, by its odometry."""
        for each in self.known:
            way_m = rotation(float(each.pose[2]) + turn_rad / 2) @ (ahead_m, left_m)
            each.pose = moved(each.pose, way_m, turn_rad)

    def starts(self, others: Floats) -> Floats:
        """Returns start poses (k, 3) for this frame's match: the known ones, then `others` (n, 3)."""
        return np.vstack([each.pose for each in self.known] + [others])

    def update(self, poses: Floats, scores: Floats, interval_s: float) -> None:
        """Takes the matched poses and scores of `starts`, and the time since the last frame."""
        count, memory = len(self.known), _MEMORY ** (interval_s / _MEMORY_S)
        for each, pose, score in zip(self.known, poses, scores, strict=False):
            each.pose = pose
            each.score = memory * each.score + (1 - memory) * float(score)
            each.frames += 1
            each.age_s += interval_s
        found = [Hypothesis(pose, float(score)) for pose, score in zip(poses[count:], scores[count:], strict=True)]
        oldest_first = sorted(self.known, key=lambda each: (-each.age_s, -each.frames, -each.score)) + found
        kept: list[Hypothesis] = []
        for each in oldest_first:
            if not any(_same(each.pose, other.pose) for other in kept):
                kept.append(each)
        self.known = sorted(kept, key=lambda each: -each.score)[:_MOST]

    def decided(self, good_score: float) -> Hypothesis | None:
        """Returns the best hypothesis if it is good, old enough, and far enough ahead of the rest."""
        best = self.known[0] if self.known else None
        if best is None or best.score < good_score or best.frames < _LEAST_FRAMES or best.age_s < _OLD_ENOUGH_S:
            return None
        lead = best.score - (self.known[1].score if len(self.known) > 1 else 0.0)
        return best if lead > (_CLEAR_LEAD if best.age_s < _PATIENCE_S else _PATIENT_LEAD) else None


def _same(one: Floats, other: Floats) -> bool:
    turn_rad = np.remainder(one[2] - other[2] + np.pi, 2 * np.pi) - np.pi
    return bool(np.hypot(*(one[:2] - other[:2])) < _SAME_M and abs(turn_rad) < _SAME_RAD)
