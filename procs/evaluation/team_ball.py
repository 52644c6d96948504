"""The ball as a team knows it: by single sightings, fused, and whether a robot of the team knows it at all."""

import math
from collections import defaultdict
from collections.abc import Set

import numpy as np

from procs.evaluation.beliefs import MOVING_M_S, NEAR_M, Samples, models_of, placed_ticks
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S
from procs.model.frames import Floats
from procs.model.units import US_PER_S

_STALE_S = 0.2  # older sightings of a robot are not averaged

_Sightings = dict[str, dict[int, Floats]]
"""x, y and distance of each robot's own sightings, by the tick of the exposure."""


def team_ball(piece: Piece) -> Samples:
    """Returns the samples of every measure of the ball that concerns a team, or a single sighting."""
    placed = placed_ticks(piece)
    sightings = _sightings(piece, placed)
    return _known(piece) | _single(piece, sightings) | _fusion(piece, placed, sightings)


def _known(piece: Piece) -> Samples:
    """Returns whether a robot of each team knows the ball, by tick, and how long each robot did not know it."""
    teams: dict[tuple[str, int], bool] = defaultdict(bool)
    lost_s: list[float] = []
    since: dict[str, int] = {}
    was_known: dict[str, bool] = defaultdict(bool)
    for robot, tick, model, _ in models_of(piece):
        known = bool(model.ball.known)
        teams[piece.team(robot), tick] |= known
        if was_known[robot] and not known:
            since[robot] = tick
        elif known and robot in since:
            lost_s.append((tick - since.pop(robot)) * piece.period_s)
        was_known[robot] = known
    lost_s += [math.inf] * len(since)
    return {
        "ball known to a robot of the team": np.array(list(teams.values()), np.float64),
        "ball lost, until known again": np.array(lost_s),
    }


def _single(piece: Piece, sightings: _Sightings) -> Samples:
    """Returns squared errors of the sightings that robots tell, by their own poses, at the time of the exposure."""
    resting: list[float] = []
    moving: list[float] = []
    for seen in sightings.values():
        for tick, (x_m, y_m, distance_m) in seen.items():
            truth = piece.truth.get(tick)
            if truth is None or tick * piece.period_s < START_S or distance_m > NEAR_M:
                continue
            error_m2 = (x_m - truth.ball_x_m) ** 2 + (y_m - truth.ball_y_m) ** 2
            moves = math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s) >= MOVING_M_S
            (moving if moves else resting).append(error_m2)
    return {"one sighting, ball resting": np.array(resting), "one sighting, ball moving": np.array(moving)}


def _fusion(piece: Piece, placed: Set[int], sightings: _Sightings) -> Samples:
    """Squared errors of the fused ball beside those of a single robot and of the plain average, by team and tick.

    A ball in the air counts, too: the fusion has to tell where it is although single robots take it for another place.
    """
    best: list[tuple[float, float]] = []
    middle: list[tuple[float, float]] = []
    average: list[tuple[float, float]] = []
    fused: dict[tuple[str, int], list[float]] = defaultdict(list)
    for robot, tick, model, truth in models_of(piece):
        if model.ball.known and tick not in placed:
            error_m2 = (model.ball.x_m - truth.ball_x_m) ** 2 + (model.ball.y_m - truth.ball_y_m) ** 2
            fused[piece.team(robot), tick].append(error_m2)
    for (team, tick), errors_m2 in fused.items():
        recent = [
            (seen_tick, each)
            for robot, seen in sightings.items()
            if piece.team(robot) == team
            for seen_tick, each in _newest(seen, tick, _STALE_S / piece.period_s)
        ]
        truth = piece.truth[tick]
        ball_m, error_m2 = np.array((truth.ball_x_m, truth.ball_y_m)), float(np.mean(errors_m2))
        now = [each for seen_tick, each in recent if seen_tick == tick]
        if now:
            single = min(now, key=lambda each: each[2])[:2] - ball_m
            best.append((error_m2, float(single @ single)))
        if recent:
            singles_m2 = [float(np.square(each[:2] - ball_m).sum()) for _, each in recent]
            middle.append((error_m2, float(np.median(singles_m2))))
            mean = np.mean([each[:2] for _, each in recent], axis=0) - ball_m
            average.append((error_m2, float(mean @ mean)))
    return {
        "fused to best single": np.array(best).reshape(-1, 2),
        "fused to median robot": np.array(middle).reshape(-1, 2),
        "fused to plain average": np.array(average).reshape(-1, 2),
    }


def _sightings(piece: Piece, placed: Set[int]) -> _Sightings:
    """Returns what robots told, without sightings of a ball that the crew was putting down."""
    found: _Sightings = defaultdict(dict)
    for robot, told in piece.by_robot.get("team_message", {}).items():
        for each in told.values():
            exposed = each.ball_capture_us / US_PER_S / piece.period_s  # in ticks
            around = {math.floor(exposed + 1e-6), math.ceil(exposed - 1e-6)}
            if each.ball_visible and not around & placed:
                found[robot][round(exposed)] = np.array((each.ball_x_m, each.ball_y_m, each.ball_distance_m))
    return found


def _newest(seen: dict[int, Floats], tick: int, within: float) -> list[tuple[int, Floats]]:
    ticks = [each for each in range(tick, tick - round(within) - 1, -1) if each in seen]
    return [(ticks[0], seen[ticks[0]])] if ticks else []
