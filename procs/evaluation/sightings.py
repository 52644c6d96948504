"""Sightings of the ball by single cameras, frame by frame: how many balls are found, and how many do not exist."""

import math

import numpy as np

from lcmtypes.soccer import ball_candidate_t, ball_percept_t
from procs.evaluation.beliefs import Samples, flies, placed_ticks
from procs.evaluation.exposures import frames_of, scene_at
from procs.evaluation.piece import Piece
from procs.model.frames import Floats
from procs.simulation.sight import hidden

_REACHES_M = (("up to 2.5 m", 0.0, 2.5), ("2.5 to 5 m", 2.5, 5.0), ("5 to 7.5 m", 5.0, 7.5))
"""Name and limits of each distance that is measured."""
_SAME_M, _SAME_SHARE = 0.3, 0.2  # a ball further from the true one, with this share of its distance, is another one


def sightings(piece: Piece) -> Samples:
    """Returns whether each frame shows the ball, and whether it shows a ball where there is none.

    Counted are balls on the ground; found must be those that no robot hides, not even in part.
    """
    found: dict[str, list[bool]] = {f"ball found in a frame, {name}": [] for name, _, _ in _REACHES_M}
    false: list[bool] = []
    placed = placed_ticks(piece)
    for robot, tick, exposed, percept in frames_of(piece):
        scene, first = scene_at(piece, robot, exposed), math.floor(exposed)
        ticks = {each for each in (first, first + 1, tick) if each in piece.truth}
        if scene is None or ticks & placed or any(flies(piece.truth[each]) for each in ticks):
            continue
        false.append(bool(percept.visible) and not _is_at(percept, scene.ball_m))
        away_m = math.hypot(*scene.ball_m)
        if hidden(scene.ball_m[None], scene.others_m, piece.model.radius_m)[0] == 0.0:
            seen: list[ball_percept_t | ball_candidate_t] = [percept] if percept.visible else []
            seen += percept.others
            for name, least_m, most_m in _REACHES_M:
                if least_m <= away_m < most_m:
                    found[f"ball found in a frame, {name}"].append(any(_is_at(one, scene.ball_m) for one in seen))
    return {name: np.array(values, np.float64) for name, values in found.items()} | {
        "balls that do not exist, a frame": np.array(false, np.float64)
    }


def _is_at(seen: ball_percept_t | ball_candidate_t, ball_m: Floats) -> bool:
    """Returns whether a ball that was found is the true one."""
    return math.dist((seen.x_m, seen.y_m), ball_m) <= _SAME_M + _SAME_SHARE * math.hypot(*ball_m)
