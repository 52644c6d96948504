"""The ball as a team knows it: by single sightings, fused, and whether a robot of the team knows it at all."""

import math
from collections import defaultdict
from collections.abc import Mapping, Set
from typing import NamedTuple

import numpy as np

from lcmtypes.soccer import ground_truth_t
from procs.evaluation.beliefs import MOVING_M_S, NEAR_M, Samples, models_of, placed_ticks
from procs.evaluation.exposures import around, truth_at
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S
from procs.model.frames import Floats
from procs.model.units import US_PER_S

_STALE_S = 0.2  # older sightings of a robot are not averaged
_AGAIN_S = 1.0  # a robot has so long to find the ball again, or its loss does not count


class _Sighting(NamedTuple):
    """A robot's own sighting of the ball."""

    exposed: float
    """Time of the exposure, in ticks."""
    place_m: Floats
    """(2), world frame, by the robot's own pose."""
    distance_m: float


_Sightings = dict[str, dict[int, _Sighting]]
"""Own sightings of each robot by the tick in which it tells them; no mate knows them sooner."""
_Balls = dict[str, dict[int, Floats]]
"""Balls (2) that each robot of a team knows, by tick."""


def team_ball(piece: Piece) -> Samples:
    """Returns the samples of every measure of the ball that concerns a team, or a single sighting."""
    placed = placed_ticks(piece)
    sightings = _sightings(piece, placed)
    return _known(piece) | _single(piece, sightings) | _fusion(piece, placed, sightings)


def _known(piece: Piece) -> Samples:
    """Returns whether a robot of each team knows the ball, by tick, and how long each robot did not know it.

    A loss that the piece ends within `_AGAIN_S` does not count, found again or not: otherwise short ones alone would.
    """
    teams: dict[tuple[str, int], bool] = defaultdict(bool)
    lost_s: list[float] = []
    since: dict[str, int] = {}
    was_known: dict[str, bool] = defaultdict(bool)
    latest = max(piece.truth) - round(_AGAIN_S / piece.period_s)
    for robot, tick, model, _ in models_of(piece):
        known = bool(model.ball.known)
        teams[piece.team(robot), tick] |= known
        if was_known[robot] and not known and tick <= latest:
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
    for told in sightings.values():
        for each in {each.exposed: each for each in told.values()}.values():
            truth = truth_at(piece, each.exposed)
            if truth is None or each.exposed * piece.period_s < START_S or each.distance_m > NEAR_M:
                continue
            moves = math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s) >= MOVING_M_S
            (moving if moves else resting).append(_error_m2(each, truth))
    return {"one sighting, ball resting": np.array(resting), "one sighting, ball moving": np.array(moving)}


def _fusion(piece: Piece, placed: Set[int], sightings: _Sightings) -> Samples:
    """Squared errors of the fused ball beside those of a single robot and of the plain average, by team and tick.

    A sighting counts in the tick in which its robot tells it, as a place of the ball then: no fusion can know it
    sooner. That of the nearest robot is compared at its exposure, too. A ball in the air counts: the fusion has to tell
    where it is although single robots take it for another place.
    """
    best: list[tuple[float, float]] = []
    exposed: list[tuple[float, float]] = []
    middle: list[tuple[float, float]] = []
    average: list[tuple[float, float]] = []
    balls = _known_balls(piece, placed)
    for (team, tick), error_m2 in _fused(piece, balls).items():
        of_team = [told for robot, told in sightings.items() if piece.team(robot) == team]
        recent = [each for told in of_team for each in _newest(told, tick, _STALE_S / piece.period_s)]
        truth = piece.truth[tick]
        if fresh := [told[tick] for told in of_team if tick in told]:
            best.append((error_m2, _error_m2(min(fresh, key=_distance_m), truth)))
        if then := [each for told in of_team for each in told.values() if round(each.exposed) == tick]:
            exposed += _at_exposure(piece, balls[team], min(then, key=_distance_m))
        if recent:
            middle.append((error_m2, float(np.median([_error_m2(each, truth) for each in recent]))))
            mean_m = np.mean([each.place_m for each in recent], axis=0)
            average.append((error_m2, _off_m2(mean_m, truth)))
    return {
        "fused to best single": np.array(best).reshape(-1, 2),
        "fused to best single at its exposure": np.array(exposed).reshape(-1, 2),
        "fused to median robot": np.array(middle).reshape(-1, 2),
        "fused to plain average": np.array(average).reshape(-1, 2),
    }


def _known_balls(piece: Piece, placed: Set[int]) -> dict[str, _Balls]:
    """Returns the balls that the robots of each team know, without those that the crew was putting down."""
    balls: dict[str, _Balls] = defaultdict(lambda: defaultdict(dict))
    for robot, tick, model, _ in models_of(piece):
        if model.ball.known and tick not in placed:
            balls[piece.team(robot)][robot][tick] = np.array((model.ball.x_m, model.ball.y_m))
    return balls


def _fused(piece: Piece, balls: Mapping[str, _Balls]) -> dict[tuple[str, int], float]:
    """Returns the mean squared error of the ball that the robots of a team know, by team and tick."""
    errors_m2: dict[tuple[str, int], list[float]] = defaultdict(list)
    for team, known in balls.items():
        for places_m in known.values():
            for tick, place_m in places_m.items():
                errors_m2[team, tick].append(_off_m2(place_m, piece.truth[tick]))
    return {place: float(np.mean(each)) for place, each in errors_m2.items()}


def _at_exposure(piece: Piece, known: _Balls, sighting: _Sighting) -> list[tuple[float, float]]:
    """Returns the squared errors of the fused ball and of a sighting at its exposure, between two ticks."""
    truth = truth_at(piece, sighting.exposed)
    errors_m2 = []
    for places_m in known.values():
        before_m, after_m, share = around(places_m, sighting.exposed)
        if truth and before_m is not None and after_m is not None:
            errors_m2.append(_off_m2(before_m + share * (after_m - before_m), truth))
    return [(float(np.mean(errors_m2)), _error_m2(sighting, truth))] if truth and errors_m2 else []


def _sightings(piece: Piece, placed: Set[int]) -> _Sightings:
    """Returns what robots told, without sightings of a ball that the crew was putting down."""
    found: _Sightings = defaultdict(dict)
    for robot, told in piece.by_robot.get("team_message", {}).items():
        for tick, each in told.items():
            exposed = each.ball_capture_us / US_PER_S / piece.period_s
            around = {math.floor(exposed + 1e-6), math.ceil(exposed - 1e-6)}
            if each.ball_visible and not around & placed:
                place_m = np.array((each.ball_x_m, each.ball_y_m))
                found[robot][tick] = _Sighting(exposed, place_m, each.ball_distance_m)
    return found


def _newest(told: Mapping[int, _Sighting], tick: int, within: float) -> list[_Sighting]:
    """Returns the newest sighting that was told up to a tick, unless it was told too long ago."""
    return [told[each] for each in range(tick, tick - round(within) - 1, -1) if each in told][:1]


def _error_m2(sighting: _Sighting, truth: ground_truth_t) -> float:
    return _off_m2(sighting.place_m, truth)


def _off_m2(place_m: Floats, truth: ground_truth_t) -> float:
    """Returns the squared distance of a place from the ball."""
    return float((place_m[0] - truth.ball_x_m) ** 2 + (place_m[1] - truth.ball_y_m) ** 2)


def _distance_m(sighting: _Sighting) -> float:
    return sighting.distance_m
