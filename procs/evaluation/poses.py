"""Errors of what robots believe about their own poses, and how soon a robot that was carried away knows its place."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from lcmtypes.soccer import pose_t, true_robot_t
from procs.evaluation.piece import Piece
from procs.model.frames import Floats
from procs.model.geometry import plausible, wrap_rad

START_S = 4.0
"""Time until all robots know their places; nothing before counts."""
FOUND_S = 10.0
"""A robot that was carried away has so long to find its place."""
_WRONG_M, _WRONG_RAD = 1.0, 0.5
_RIGHT_M, _RIGHT_RAD = 0.3, 0.3
_CARRIED_M_S, _CARRIED_RAD_S = 8.0, 12.0  # a robot that moves or turns faster, twice as fast as it can, was carried
_STANDS_M_S, _STANDS_RAD_S = 0.05, 0.1  # a robot that moves no faster stands
_JUMP_M = 0.5  # a believed pose that departs so far from the true motion within a tick has jumped


class _Belief(NamedTuple):
    """Belief of a robot about its pose in one tick, beside the truth."""

    tick: int
    ticks: int
    """Ticks since the belief before; more than one with `every`."""
    localized: bool
    error_m: float
    error_rad: float
    jump_m: float
    """Change of the error in position, as a vector, since the belief before."""
    carried: bool
    """The robot was set down elsewhere since the belief before."""
    stands: bool
    """The robot neither drives nor turns."""

    @property
    def wrong(self) -> bool:
        """A wrong pose is believed."""
        return self.localized and (self.error_m > _WRONG_M or self.error_rad > _WRONG_RAD)

    @property
    def right(self) -> bool:
        """A right pose is believed."""
        return self.localized and self.error_m < _RIGHT_M and self.error_rad < _RIGHT_RAD


def pose_samples(piece: Piece, interface: str = "pose", prefix: str = "") -> dict[str, Floats]:
    """Returns the samples of the poses in an interface of the robots; `prefix` goes before each name.

    A robot that was carried away cannot know that at once: until it knows that it is lost, or knows its place, its
    errors do not count, and neither does the jump to its right place.
    """
    errors: list[tuple[float, float]] = []  # squared, of position and heading
    standing: list[tuple[float, float]] = []
    known: list[bool] = []
    found_s: list[float] = []
    wrongs = jumps = ticks = 0
    for robot in sorted(piece.by_robot.get(interface, {})):
        unaware = was_wrong = was_localized = False
        beliefs = list(_beliefs(piece, interface, robot))
        found_s += _found_s(beliefs, piece.period_s)
        for belief in beliefs:
            returns = unaware and belief.right
            unaware = (unaware or belief.carried) and belief.wrong
            if not unaware:
                known.append(belief.localized)
                ticks += belief.ticks * belief.localized
                wrongs += belief.wrong and not was_wrong
                jumped = belief.jump_m > _JUMP_M and belief.localized and was_localized
                jumps += jumped and not (belief.carried or returns)
                if belief.localized:
                    errors.append((belief.error_m**2, belief.error_rad**2))
                    if belief.stands:
                        standing.append(errors[-1])
            was_wrong, was_localized = belief.wrong, belief.localized
    all_errors, standing_errors = (np.array(each, np.float64).reshape(-1, 2) for each in (errors, standing))
    samples = {
        "pose known": np.array(known, np.float64),
        "pose, position": all_errors[:, 0],
        "pose, position, 99 %": all_errors[:, 0],
        "pose, heading": all_errors[:, 1],
        "pose, robot stands, position": standing_errors[:, 0],
        "pose, robot stands, heading": standing_errors[:, 1],
        "wrong pose believed": np.array([(wrongs, ticks * piece.period_s / 60 / 1000)]),
        "pose jumps": np.array([(jumps, ticks * piece.period_s / 60)]),
        "kidnapped, found within 10 s": np.array([time_s <= FOUND_S for time_s in found_s], np.float64),
        "kidnapped, time until found": np.array(found_s),
    }
    return {prefix + name: values for name, values in samples.items()}


def _beliefs(piece: Piece, interface: str, robot: str) -> Iterator[_Belief]:
    """Yields the beliefs of a robot in the order of the ticks."""
    before = 0  # tick of the belief before
    error_before = (0.0, 0.0)
    told: dict[int, pose_t] = piece.by_robot[interface][robot]
    carried = _carried(piece, robot)
    for tick, pose in sorted(told.items()):
        if tick in piece.truth and tick * piece.period_s >= START_S:
            own, since = piece.robot(tick, robot), range((before or tick - 1) + 1, tick + 1)
            error, off_rad = (pose.x_m - own.x_m, pose.y_m - own.y_m), pose.heading_rad - own.heading_rad
            if plausible(*error, off_rad):
                off_rad = abs(wrap_rad(off_rad))
            else:  # no pose at all: it is wrong, and shows
                error, off_rad = (math.inf, math.inf), math.inf
            jump_m = math.dist(error, error_before) if before else 0.0
            before, error_before = tick, error
            yield _Belief(
                tick,
                len(since),
                bool(pose.localized),
                math.hypot(*error),
                off_rad,
                jump_m,
                not carried.isdisjoint(since),
                math.hypot(own.vx_m_s, own.vy_m_s) <= _STANDS_M_S and abs(own.omega_rad_s) <= _STANDS_RAD_S,
            )


def _carried(piece: Piece, robot: str) -> set[int]:
    """Returns the ticks in which a robot was set down elsewhere."""
    poses = [(tick, own) for tick, truth in sorted(piece.truth.items()) for own in truth.robots if own.name == robot]
    return {tick for (_, before), (tick, own) in pairwise(poses) if _is_carried(before, own, piece.period_s)}


def _is_carried(before: true_robot_t, robot: true_robot_t, period_s: float) -> bool:
    """Returns whether a robot has moved or turned within a tick as no robot can."""
    way_m = math.dist((before.x_m, before.y_m), (robot.x_m, robot.y_m))
    turn_rad = abs(wrap_rad(robot.heading_rad - before.heading_rad))
    return way_m > _CARRIED_M_S * period_s or turn_rad > _CARRIED_RAD_S * period_s


def _found_s(beliefs: list[_Belief], period_s: float) -> list[float]:
    """Returns for each kidnapping the time until the place is known; infinite if it is not within `FOUND_S`.

    A kidnapping that the robot has less time for, before the next one or the end, does not count.
    """
    times_s = []
    for place, belief in enumerate(beliefs):
        if belief.carried:
            until, last = belief.tick + round(FOUND_S / period_s), beliefs[-1]
            rest = [each for each in beliefs[place + 1 :] if each.tick <= until]
            if last.tick + last.ticks > until and not any(each.carried for each in rest):
                found = next((each.tick for each in rest if each.right), math.inf)
                times_s.append((found - belief.tick) * period_s)
    return times_s
