"""Feet of black bodies on the rays of a star scan: where the carpet ends and something black begins."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce
from operator import and_, or_

import numpy as np

from procs.model.algebra import Floats, Indices
from procs.vision.colours import ColourRange, Mask, Picture
from procs.vision.scan import Scan

_BODY_SAMPLES = 4  # so many black samples in a row are a body
_COVERED = 0.75  # if a larger share of the rays begins black, the camera is covered
_FEET_SAMPLES = 3  # a foot is hidden unless carpet is visible within so many samples before it
_BEHIND = 1.7  # black that begins at most so much farther belongs to the foot beside it: a ball hides as much
_NEARER = 0.9  # likewise, nearer


@dataclass(frozen=True)
class Feet:
    """Feet (n) of bodies, counter-clockwise."""

    rays: Indices
    """Rays (n) that meet the bodies, in order."""
    points_m: Floats
    """Places (n, 2) on the ground, robot frame."""
    seen: Mask
    """Whether each foot is seen; if not, something before the body hides it, such as a ball, and only the direction of
    its place is known."""

    def __len__(self) -> int:
        return len(self.rays)

    def part(self, which: slice | Indices) -> "Feet":
        """Returns some of the feet."""
        return Feet(self.rays[which], self.points_m[which], self.seen[which])

    def seen_m(self) -> Floats:
        """Returns the places (m, 2) of the feet that are seen; of all if none is."""
        seen = np.count_nonzero(self.seen)
        return self.points_m if seen in (0, len(self)) else self.points_m[self.seen]

    def beginning_at(self, first: int) -> "Feet":
        """Returns the feet beginning with another one; those before it come last."""
        return self.part(np.roll(np.arange(len(self)), -first)) if first else self


NO_FEET = Feet(np.empty(0, np.intp), np.empty((0, 2)), np.empty(0, bool))


def feet_in(hsv: Picture, star: Scan, black: ColourRange, carpet: Sequence[ColourRange]) -> Feet:
    """Returns the feet in a scan (rays, samples, 3) in HSV; `carpet` are the colours of the carpet and its lines."""
    if hsv.shape[1] < _BODY_SAMPLES:
        return NO_FEET
    dark = black.mask(hsv)
    last = dark.shape[1] - _BODY_SAMPLES + 1
    body = reduce(and_, (dark[:, i : last + i] for i in range(_BODY_SAMPLES)))
    rays = np.flatnonzero(body.any(axis=1))
    starts = body[rays].argmax(axis=1)
    if (starts == 0).sum() > _COVERED * len(body):
        return NO_FEET
    seen = (starts == 0) | _any_before(hsv, rays, starts, carpet)
    points_m = (star.ground_m[rays, starts] + star.ground_m[rays, np.maximum(starts - 1, 0)]) / 2
    if seen.all():
        return Feet(rays, points_m, seen)
    return _with_hidden(Feet(rays, points_m, seen), len(body))


def _any_before(hsv: Picture, rays: Indices, starts: Indices, colours: Sequence[ColourRange]) -> Mask:
    """Returns flags (n): whether one of the last samples before `starts` (n) on the rays (n) has one of the colours."""
    before = hsv[rays[:, None], (starts[:, None] - np.arange(1, _FEET_SAMPLES + 1)).clip(0)]
    return np.asarray(reduce(or_, (colour.mask(before) for colour in colours)).any(axis=1))


def _with_hidden(feet: Feet, ray_count: int) -> Feet:
    """Returns the feet that are seen, and the hidden ones beside them, as far away as the nearer neighbour is."""
    ranges_m = np.hypot(feet.points_m[:, 0], feet.points_m[:, 1]).tolist()
    found = list(zip(feet.rays.tolist(), ranges_m, feet.seen.tolist(), strict=True))
    seen_m = {ray: range_m for ray, range_m, seen in found if seen}
    hidden_m = {ray: range_m for ray, range_m, seen in found if not seen}
    left_m, right_m = (_beside(step, hidden_m, seen_m, ray_count) for step in (1, -1))
    away_m = {ray: min(left_m.get(ray, math.inf), right_m.get(ray, math.inf)) for ray in {**left_m, **right_m}}
    scale = np.array([away_m[ray] / range_m if ray in away_m else 0.0 for ray, range_m, _ in found])
    kept = feet.part(np.flatnonzero(scale))
    return Feet(kept.rays, kept.points_m * scale[scale > 0.0, None], kept.seen)


def _beside(step: int, hidden_m: dict[int, float], seen_m: dict[int, float], ray_count: int) -> dict[int, float]:
    """Returns distances by ray: of feet that are seen, and of hidden ones as far as neighbours in one direction are."""
    away_m = dict(seen_m)
    row = sorted(hidden_m, reverse=step > 0)
    for ray in row + row:  # twice: neighbours may go around from the last ray to the first
        beside_m = away_m.get((ray + step) % ray_count)
        if ray not in away_m and beside_m and _NEARER * beside_m < hidden_m[ray] < _BEHIND * beside_m:
            away_m[ray] = beside_m
    return away_m
