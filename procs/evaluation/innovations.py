"""Innovations of the ball: how a robot's own sightings differ from what it expected.

A filter that uses all that its measurements tell leaves innovations that do not depend on each other: white ones.
"""

import math
from collections.abc import Iterator

import numpy as np

from procs.evaluation.beliefs import Samples, flies, placed_ticks
from procs.evaluation.exposures import Frame, frames_of, pose_at
from procs.evaluation.piece import Piece
from procs.model.covariance import is_positive
from procs.model.frames import Floats, to_world

_GATE = 13.8  # chi-square, 2 degrees of freedom, 99.9 %: beyond it the ball was kicked, or another one was seen
_NEXT_S = 0.12  # from one frame to the next, at most


def innovations(piece: Piece) -> Samples:
    """Returns products of successive whitened innovations, beside their mean squares; their ratio is a correlation."""
    products: list[tuple[float, float]] = []
    before: tuple[Frame, Floats] | None = None
    for frame, innovation in _innovations(piece):
        between_s = (frame.exposed - before[0].exposed) * piece.period_s if before is not None else math.inf
        if before is not None and before[0].robot == frame.robot and between_s <= _NEXT_S + 1e-9:
            former = before[1]
            squares = float(former @ former + innovation @ innovation) / 2
            products.append((float(former @ innovation), squares))
        before = frame, innovation
    return {"ball innovations, correlation of successive": np.array(products, np.float64).reshape(-1, 2)}


def _innovations(piece: Piece) -> Iterator[tuple[Frame, Floats]]:
    """Yields frames that show the ball, and the innovation (2) of each in standard deviations."""
    placed = placed_ticks(piece)
    for frame in frames_of(piece):
        robot, tick, exposed, percept = frame
        model = piece.by_robot.get("world_model", {}).get(robot, {}).get(tick - 1)
        poses = piece.by_robot.get("pose", {}).get(robot, {})
        own = pose_at(poses, exposed)
        truth, now = piece.truth.get(tick), poses.get(tick)
        if not (percept.visible and model and model.ball.known and truth and now) or own is None:
            continue
        if tick in placed or flies(truth):
            continue
        ahead_s = (exposed - (tick - 1)) * piece.period_s
        expected_m = np.array(
            (model.ball.x_m + ahead_s * model.ball.vx_m_s, model.ball.y_m + ahead_s * model.ball.vy_m_s)
        )
        seen_m, by_sight_m2, by_pose_m2 = to_world(
            own,
            np.array(now.covariance),
            np.array([(percept.x_m, percept.y_m)]),
            np.array([percept.covariance_m2]),
        )
        spread_m2 = by_sight_m2[0] + by_pose_m2[0] + np.array(model.ball.covariance)[:2, :2]
        if not is_positive(spread_m2.tolist()):
            continue  # nothing is claimed
        innovation = np.linalg.solve(np.linalg.cholesky(spread_m2), seen_m[0] - expected_m)
        if innovation @ innovation <= _GATE:
            yield frame, innovation
