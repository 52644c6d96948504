"""Errors of the robots' beliefs about ball, robots and themselves, sample by sample."""

import itertools
import math
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from lcmtypes.soccer import ground_truth_t, match_event_t, robot_estimate_t, true_robot_t, world_model_t
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S, pose_samples
from procs.model.covariance import is_positive
from procs.model.frames import Floats

NEAR_M = 4.0
"""Distance from the observer to which published accuracies of ball and obstacles refer."""
MOVING_M_S = 0.3
"""A ball slower than that counts as resting."""
SETTLED_S = 0.3
"""A ball without a touch or a bounce for that time rolls freely."""
_CONTACT_S = 0.1
_INSIDE_95 = 5.991  # chi-square, 2 degrees of freedom
_PLACED_S = 0.5  # the crew puts the ball down in no time, which no ball in play does
_SAME_M = 1.0  # an opponent further from all robots is not one of them
_DRIVING_M_S = 0.5
_KICK_M_S = 2.0
_JUMP_M = 0.2
_BOUNCE_M_S = 1.0  # no ball that rolls or slides changes its velocity by so much in a tick
_KNOWN_SHARE = 0.1

PARTICLES, AVERAGE = "200 particles: ", "plain average: "
"""Begins of the names of what baselines reach that observe the same match."""

Samples = dict[str, Floats]
"""Measure to its samples: (n), or (n, 2) where the measure is a ratio."""


class _Ball(NamedTuple):
    """Belief of one robot about the ball in one tick, beside the truth."""

    error_m2: float
    velocity_error_m2_s2: float
    surprise: float
    """Squared error by the robot's own covariance, two on average if it is honest (NEES)."""
    near: bool
    speed_m_s: float
    holder: str
    """`itself`, `another`, or empty: the robot that touches the ball."""
    settled: bool
    """Nothing has touched or turned the ball for a moment."""
    flies: bool
    """The ball is in the air."""
    height_error_m2: float

    @property
    def inside(self) -> bool:
        """The truth lies within the ellipse that holds it with a probability of 95 %."""
        return self.surprise < _INSIDE_95


def believed(piece: Piece) -> Samples:
    """Returns the samples of every measure of beliefs."""
    own = pose_samples(piece) | _ball_samples(piece) | _kicks(piece) | _opponents(piece)
    return own | _baselines(piece)


def _baselines(piece: Piece) -> Samples:
    """Returns the samples of the localization by particles, and of the plain average of the team's sightings."""
    averages = _ball_samples(piece, "average_ball")
    names = ("ball moving, position", "ball rolling freely, position", "ball resting, position")
    return pose_samples(piece, "particle_pose", PARTICLES) | {AVERAGE + name: averages[name] for name in names}


def models_of(piece: Piece, interface: str = "world_model") -> Iterator[tuple[str, int, world_model_t, ground_truth_t]]:
    """Yields robot, tick, its model and the truth of that tick; robot by robot, tick by tick."""
    for robot, models in sorted(piece.by_robot.get(interface, {}).items()):
        for tick, model in models.items():
            if tick * piece.period_s >= START_S and tick in piece.truth:
                yield robot, tick, model, piece.truth[tick]


def _ball_samples(piece: Piece, interface: str = "world_model") -> Samples:
    seen: list[_Ball] = []
    known: list[bool] = []
    placed, bounced = placed_ticks(piece), _bounced(piece)
    for robot, tick, model, truth in models_of(piece, interface):
        known.append(model.ball.known)
        if model.ball.known and tick not in placed:
            seen.append(_ball(piece, robot, tick, model, truth, tick in bounced))

    def of(value: str, *, case: list[bool]) -> Floats:
        return np.array([getattr(each, value) for each, asked in zip(seen, case, strict=True) if asked], np.float64)

    moving = [each.near and not each.flies and each.speed_m_s >= MOVING_M_S for each in seen]
    rolling = [asked and each.settled for each, asked in zip(seen, moving, strict=True)]
    resting = [each.near and each.settled and each.speed_m_s < 0.01 for each in seen]
    in_the_air = [each.near and each.flies for each in seen]
    every = [True] * len(seen)
    return {
        "ball known": np.array(known, np.float64),
        "ball moving, position": of("error_m2", case=moving),
        "ball moving, velocity": of("velocity_error_m2_s2", case=moving),
        "ball rolling freely, position": of("error_m2", case=rolling),
        "ball rolling freely, velocity": of("velocity_error_m2_s2", case=rolling),
        "ball in the air, position": of("error_m2", case=in_the_air),
        "ball in the air, velocity": of("velocity_error_m2_s2", case=in_the_air),
        "ball in the air, height": of("height_error_m2", case=in_the_air),
        "ball resting, position": of("error_m2", case=resting),
        "ball resting, velocity": of("velocity_error_m2_s2", case=resting),
        "ball, squared error by its covariance": of("surprise", case=[math.isfinite(each.surprise) for each in seen]),
        "inside 95 %, all": of("inside", case=every),
        "inside 95 %, rolling freely": of("inside", case=rolling),
        "inside 95 %, resting": of("inside", case=resting),
        "inside 95 %, held by another": of("inside", case=[each.holder == "another" for each in seen]),
        "inside 95 %, held by itself": of("inside", case=[each.holder == "itself" for each in seen]),
    }


def placed_ticks(piece: Piece) -> set[int]:
    """Returns the ticks in which, or shortly before which, the crew put the ball elsewhere.

    The ball has jumped, or the touch before is forgotten, which only happens to a ball that is placed.
    """
    ticks: set[int] = set()
    for (earlier, before), (tick, truth) in itertools.pairwise(sorted(piece.truth.items())):
        forgotten = piece.last_touch.get(earlier) and not piece.last_touch.get(tick)
        way_m = math.dist((before.ball_x_m, before.ball_y_m), (truth.ball_x_m, truth.ball_y_m))
        speed_m_s = max(math.hypot(each.ball_vx_m_s, each.ball_vy_m_s) for each in (before, truth))
        if forgotten or way_m > _JUMP_M + speed_m_s * piece.period_s:
            ticks.update(range(tick, tick + round(_PLACED_S / piece.period_s)))
    return ticks


def _bounced(piece: Piece) -> set[int]:
    """Returns the ticks in which, or shortly before which, a wall, a post or a net turned or stopped the ball."""
    ticks: set[int] = set()
    for (_, before), (tick, truth) in itertools.pairwise(sorted(piece.truth.items())):
        if _change_m_s(before, truth) > _BOUNCE_M_S:
            ticks.update(range(tick, tick + round(SETTLED_S / piece.period_s) + 1))
    return ticks


def _change_m_s(before: ground_truth_t, truth: ground_truth_t) -> float:
    """Returns the change of the ball's velocity over the ground."""
    return math.hypot(truth.ball_vx_m_s - before.ball_vx_m_s, truth.ball_vy_m_s - before.ball_vy_m_s)


def flies(truth: ground_truth_t) -> bool:
    """Returns whether the ball is above the ground, or bounces on it."""
    return truth.ball_z_m > 0.0 or truth.ball_vz_m_s != 0.0


def _ball(piece: Piece, robot: str, tick: int, model: world_model_t, truth: ground_truth_t, bounced: bool) -> _Ball:
    own, ball = piece.robot(tick, robot), model.ball
    error = np.array((ball.x_m - truth.ball_x_m, ball.y_m - truth.ball_y_m))
    covariance = np.array(ball.covariance)[:2, :2]
    touching = piece.touched_by(tick, _CONTACT_S)
    return _Ball(
        _counted(float(error @ error)),
        _counted((ball.vx_m_s - truth.ball_vx_m_s) ** 2 + (ball.vy_m_s - truth.ball_vy_m_s) ** 2),
        surprise_of(covariance, error),
        math.dist((own.x_m, own.y_m), (truth.ball_x_m, truth.ball_y_m)) <= NEAR_M,
        math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s),
        "itself" if robot in touching else "another" if touching else "",
        not bounced and not piece.touched_by(tick, SETTLED_S),
        flies(truth),
        _counted((ball.z_m - truth.ball_z_m) ** 2),
    )


def _counted(square: float) -> float:
    """Returns a squared error; that of a belief that is no number is infinite, so that it shows."""
    return math.inf if math.isnan(square) else square


def covers(covariance: Floats, error: Floats) -> bool:
    """Returns whether an error (2) lies within the ellipse of its covariance (2, 2) that holds 95 % of all errors."""
    return surprise_of(covariance, error) < _INSIDE_95


def surprise_of(covariance: Floats, error: Floats) -> float:
    """Returns the square of an error (2) by its covariance (2, 2); infinite for a matrix that covers nothing."""
    return float(error @ np.linalg.solve(covariance, error)) if is_positive(covariance.tolist()) else math.inf


def _kicks(piece: Piece) -> Samples:
    """Seconds from a kick until each robot knows the ball's velocity within a tenth; infinite if it never does.

    A kick against a robot, a wall or a post does not count: the ball has another velocity at once.
    """
    delays_s: list[float] = []
    own_s: list[float] = []
    for tick, events in piece.events.items():
        for kick in events:
            if kick.kind == match_event_t.KICK and kick.speed_m_s >= _KICK_M_S and tick * piece.period_s >= START_S:
                found = _delays_s(piece, tick, kick)
                delays_s += found.values()
                own_s += [delay_s for robot, delay_s in found.items() if piece.team(robot) == piece.team(kick.robot)]
    return {"velocity known after a kick": np.array(delays_s), "velocity known after an own kick": np.array(own_s)}


def _delays_s(piece: Piece, kicked: int, kick: match_event_t) -> dict[str, float]:
    """Returns the delay of each robot; none if another robot, a wall or a post soon turns the ball."""
    flight, first = [kicked], piece.truth[kicked]
    if abs(math.hypot(first.ball_vx_m_s, first.ball_vy_m_s) - kick.speed_m_s) > _BOUNCE_M_S:
        return {}
    for tick in range(kicked + 1, max(piece.truth) + 1):
        touched = piece.touched_by(tick, 0.0) - {kick.robot}
        if touched or _change_m_s(piece.truth[tick - 1], piece.truth[tick]) > _BOUNCE_M_S:
            break
        flight.append(tick)
    if len(flight) * piece.period_s < SETTLED_S:
        return {}
    delays_s = {}
    for robot, models in piece.by_robot.get("world_model", {}).items():
        found = (tick for tick in flight if tick in models and _knows(models[tick], piece.truth[tick]))
        delays_s[robot] = (next(found, math.inf) - kicked) * piece.period_s
    return delays_s


def _knows(model: world_model_t, truth: ground_truth_t) -> bool:
    error_m_s = math.hypot(model.ball.vx_m_s - truth.ball_vx_m_s, model.ball.vy_m_s - truth.ball_vy_m_s)
    return model.ball.known and error_m_s <= _KNOWN_SHARE * math.hypot(truth.ball_vx_m_s, truth.ball_vy_m_s)


def _opponents(piece: Piece) -> Samples:
    errors_m2, ghosts, found, ways = [], [], [], []
    for robot, tick, model, _ in models_of(piece):
        own, rivals = piece.robot(tick, robot), piece.rivals(tick, robot)
        near = [rival for rival in rivals if math.dist((own.x_m, own.y_m), (rival.x_m, rival.y_m)) <= NEAR_M]
        matched = []
        for estimate in model.opponents:
            rival = min(rivals, key=lambda each: _between_m(estimate, each), default=None)
            ghosts.append(rival is None or not _between_m(estimate, rival) <= _SAME_M)  # one at NaN is a ghost, too
            if rival in near and not ghosts[-1]:
                matched.append(rival.name)
                errors_m2.append(_between_m(estimate, rival) ** 2)
                if math.hypot(rival.vx_m_s, rival.vy_m_s) > _DRIVING_M_S:
                    behind = (rival.x_m - estimate.x_m) * rival.vx_m_s + (rival.y_m - estimate.y_m) * rival.vy_m_s
                    ways.append((behind, rival.vx_m_s**2 + rival.vy_m_s**2))
        found += [rival.name in matched for rival in near]
    return {
        "opponents, position": np.array(errors_m2),
        "opponents, lag": np.array(ways).reshape(-1, 2),
        "opponents known": np.array(found, np.float64),
        "opponents that do not exist": np.array(ghosts, np.float64),
    }


def _between_m(estimate: robot_estimate_t | world_model_t, robot: true_robot_t) -> float:
    return math.dist((estimate.x_m, estimate.y_m), (robot.x_m, robot.y_m))
