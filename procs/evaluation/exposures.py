"""Moments at which cameras expose, between two ticks: what was true then, and what a robot believed."""

import math
from collections.abc import Iterator, Mapping
from typing import NamedTuple, TypeVar

import numpy as np

from lcmtypes.soccer import ball_percept_t, ground_truth_t, pose_t
from procs.evaluation.piece import Piece
from procs.evaluation.poses import START_S
from procs.model.frames import Floats, rotation
from procs.model.geometry import wrap_rad
from procs.model.units import US_PER_S
from procs.simulation.past import between

T = TypeVar("T")


class Frame(NamedTuple):
    """Percept of the ball from one frame."""

    robot: str
    tick: int
    """In which the percept was written."""
    exposed: float
    """Time of the exposure, in ticks."""
    percept: ball_percept_t


class Scene(NamedTuple):
    """Truth around a robot at an exposure, in its frame."""

    ball_m: Floats
    """(2)."""
    others_m: Floats
    """(k, 2): the other robots."""


def frames_of(piece: Piece) -> Iterator[Frame]:
    """Yields the frames of all robots; robot by robot, tick by tick."""
    for robot, percepts in sorted(piece.by_robot.get("ball_percept", {}).items()):
        for tick, percept in sorted(percepts.items()):
            if tick * piece.period_s >= START_S:
                age_us = percept.header.time_us - percept.capture_us if percept.capture_us else 0
                yield Frame(robot, tick, tick - age_us / US_PER_S / piece.period_s, percept)


def truth_at(piece: Piece, exposed: float) -> ground_truth_t | None:
    """Returns the world at a time in ticks; None if the ticks before and after are not of the piece."""
    before, after, share = around(piece.truth, exposed)
    return None if before is None or after is None else between(before, after, share, piece.period_s)


def scene_at(piece: Piece, robot: str, exposed: float) -> Scene | None:
    """Returns the scene around a robot at a time in ticks; None if the ticks before and after are not of the piece."""
    truth = truth_at(piece, exposed)
    if truth is None:
        return None
    places = {each.name: each for each in truth.robots}
    own = places.pop(robot, None)
    if own is None:
        return None
    others_m = [(each.x_m, each.y_m) for each in places.values()]
    offsets_m = np.array([(truth.ball_x_m, truth.ball_y_m), *others_m]) - (own.x_m, own.y_m)
    seen_m = offsets_m @ rotation(own.heading_rad)
    return Scene(seen_m[0], seen_m[1:])


def pose_at(poses: Mapping[int, pose_t], exposed: float) -> Floats | None:
    """Returns the pose (3) that a robot believed at a time in ticks; None if it did not know its place."""
    before, after, share = around(poses, exposed)
    if before is None or after is None or not (before.localized and after.localized):
        return None
    return pose_between(_values(before), _values(after), share)


def pose_between(before: Floats, after: Floats, share: float) -> Floats:
    """Returns the pose (3) on the way from one to another; headings turn the shorter way."""
    way = after - before
    way[2] = wrap_rad(float(way[2]))
    return np.asarray(before + share * way)


def around(values: Mapping[int, T], exposed: float) -> tuple[T | None, T | None, float]:
    """Returns the values before and after a time in ticks, and the share of the way from one to the next."""
    first = math.floor(exposed + 1e-6)
    share = max(0.0, exposed - first)
    return values.get(first), values.get(first + 1 if share > 1e-6 else first), share


def _values(pose: pose_t) -> Floats:
    return np.array((pose.x_m, pose.y_m, pose.heading_rad))
