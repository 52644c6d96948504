"""Finds the ball in an omnidirectional picture: colour, shape, then its place to a fraction of a pixel.

The place in the picture determines the size of a ball on the ground. A ball that looks larger is in the air, nearer
than the ground behind it; its size gives its distance.
"""

import math
from dataclasses import dataclass

import cv2
import numpy as np

from procs.model.algebra import Floats
from procs.model.ball import BALL
from procs.vision.ball_blob import Blob, blob_in
from procs.vision.colours import ColourRange, Picture, to_hsv
from procs.vision.mirror import Mirror
from procs.vision.uncertainty import plane_covariance, sphere_covariance

_STEP_PX = 2  # the first search looks at every second pixel of every second row
_MARGIN_PX = 2  # around a blob of the first search, so that the full picture shows its rim
_CANDIDATES = 4  # so many blobs, the largest ones, are examined
_MOST_SPREAD = 1.6  # mean square distance of a blob's pixels from its middle, as a multiple of a disc's
_WHOLE_SPREAD = 1.02  # the same of a whole ball in a picture
_SPREAD_PX2 = 2.0  # what noise adds to that at most, times the square of the radius in the picture
_WHOLE_FIT = 0.985  # share of the expected area that pictures show of a whole ball
_HIDDEN_SHIFT = 0.82
"""Shift of the middle of what is seen of a ball that a robot hides in part, as a share of its radius times the hidden
part of that area. Fitted, as the area, to rendered pictures that show 0.4 to 1 of a ball."""
_LEAST_DOUBT = 0.07  # about the side on which a robot hides a ball: about the size of the shift
LEAST_TOLD_PX = 3.0  # radius in the picture of a ball whose blob tells that side
_HIDDEN_SHARE = 2.6
"""Relative error of the area of a ball that a robot hides in part, divided by what that adds to its spread."""
_AREA_PX = 0.2  # relative deviation of an area, times the radius in the picture
_NEAREST_M = 0.3  # from the viewpoint; only the robot itself is nearer
IN_THE_AIR = 0.8  # confidence of a ball in the air, which is rarer than one on the ground


@dataclass(frozen=True)
class BallSighting:
    """One ball, robot frame."""

    x_m: float
    y_m: float
    z_m: float
    """Height of the ball's lowest point; 0 for a ball on the ground."""
    covariance_m2: Floats
    """2 x 2, of x and y in the robot frame."""
    confidence: float
    """0..1: how well the blob's size fits a ball that lies there; smaller for a ball in the air."""


def most_fit(radius_px: float) -> float:
    """Returns the largest plausible area of a ball on the ground, as a multiple of the area that its radius gives."""
    return 1.08 + 0.4 / radius_px


def seems_whole(spread: float, radius_px: float) -> bool:
    """Returns whether a blob seems to show a whole ball, of which no robot hides a part, so that its size is known.

    Args:
        spread: mean square distance of the blob's pixels from its middle, compared with that of a disc of its area.
            What is left of a disc behind a straight edge spreads further: by 4 % if 14 % are hidden, by 17 % if 37 %
            are.
        radius_px: radius of that disc.
    """
    return spread <= _WHOLE_SPREAD + _SPREAD_PX2 / radius_px**2


def area_share(spread: float, radius_px: float) -> float:
    """Returns the relative standard deviation of the area of a ball; see `seems_whole`."""
    return _AREA_PX / radius_px + _HIDDEN_SHARE * max(0.0, spread - _WHOLE_SPREAD)


def hidden_shift_px(fit: float, radius_px: float) -> float:
    """Returns the shift of what is seen of a ball on the ground whose blob has this share of the expected area."""
    return _HIDDEN_SHIFT * radius_px * max(0.0, _WHOLE_FIT - fit)


def unsure_px(shift_px: float, doubt: float) -> float:
    """Returns what such a shift adds to the standard deviation of the ball's place; `doubt` (0..1) about its side."""
    return shift_px * math.sqrt(0.5) * max(_LEAST_DOUBT, doubt)


@dataclass(frozen=True)
class BallFinder:
    """Finds the ball of a known colour and size, on the ground or above it."""

    mirror: Mirror
    colour: ColourRange
    radius_m: float = BALL.radius_m
    deviation_px: float = 0.3
    """Standard deviation of the found centre."""
    least_fit: float = 0.4
    """Least area of a blob, as a share of a whole ball's: robots may hide a part, but smaller blobs are not balls."""
    farthest_m: float = 8.0
    """Largest distance of a ball."""

    def find(self, pixels: Picture) -> BallSighting | None:
        """Returns the likeliest ball in a picture, height x width x 3, or None."""
        return next(iter(self.find_all(pixels)), None)

    def find_all(self, pixels: Picture) -> list[BallSighting]:
        """Returns the candidates for the ball in a picture, height x width x 3, the likeliest first."""
        coarse = cv2.resize(pixels, None, fx=1 / _STEP_PX, fy=1 / _STEP_PX, interpolation=cv2.INTER_NEAREST)
        mask = self.colour.mask(to_hsv(np.asarray(coarse, np.uint8))).view(np.uint8)
        left, top, width, height = cv2.boundingRect(mask)
        if not width:
            return []
        part = mask[top : top + height, left : left + width]  # a labelling of the whole picture takes much longer
        _, _, boxes, _ = cv2.connectedComponentsWithStats(part, connectivity=8)
        blobs = boxes[1:] + np.array((left, top, 0, 0, 0))
        largest = np.argsort(-blobs[:, cv2.CC_STAT_AREA], kind="stable")[:_CANDIDATES]
        sightings = [self._sighting(self._blob(pixels, blobs[i])) for i in largest]
        return sorted((s for s in sightings if s is not None), key=lambda s: -s.confidence)

    def _blob(self, pixels: Picture, box: cv2.typing.MatLike) -> Blob | None:
        """Measures a blob of the coarse picture in the full one."""
        left, top, width, height = (int(edge) * _STEP_PX for edge in box[: cv2.CC_STAT_AREA])
        right, bottom = left + width + _MARGIN_PX, top + height + _MARGIN_PX
        return blob_in(pixels, self.colour, left - _MARGIN_PX, top - _MARGIN_PX, right, bottom)

    def _sighting(self, blob: Blob | None) -> BallSighting | None:
        """Returns the ball at a blob; None if size or shape do not fit."""
        if blob is None:
            return None
        place = self._locate(blob.column, blob.row)
        if place is not None:
            x_m, y_m, expected_px = place
            fit = blob.area_px / (math.pi * expected_px**2)
            if fit <= most_fit(expected_px):
                return self._on_ground(blob, x_m, y_m, expected_px, fit)
        return self._in_the_air(blob)

    def _on_ground(self, blob: Blob, x_m: float, y_m: float, expected_px: float, fit: float) -> BallSighting | None:
        """Returns the ball on the ground at a blob; None if distance, size or shape do not fit."""
        confidence = min(fit, 1 / fit)
        if math.hypot(x_m, y_m) > self.farthest_m or confidence < self.least_fit or not _is_round(blob, expected_px):
            return None
        shift_px = hidden_shift_px(fit, expected_px)
        side, doubt = self._hidden_side(blob, shift_px, expected_px)
        if side and (place := self._locate(*self._beside(blob, side * shift_px))) is not None:
            x_m, y_m, _ = place
        deviation_px = self.deviation_px + unsure_px(shift_px, doubt)
        covariance_m2 = plane_covariance(self.mirror, x_m, y_m, (deviation_px, deviation_px), self.radius_m)
        return BallSighting(x_m, y_m, 0.0, covariance_m2, confidence)

    def _hidden_side(self, blob: Blob, shift_px: float, radius_px: float) -> tuple[int, float]:
        """Returns the side on which something upright hides a part of a ball, and the doubt about it, 0..1.

        1: on the left; -1: on the right; 0: unknown, or it is hidden from both sides.
        """
        if not shift_px or radius_px < LEAST_TOLD_PX:
            return 0, 1.0
        left, right = self._beside(blob, shift_px), self._beside(blob, -shift_px)
        return blob.likelier_disc(left, right, radius_px)

    def _beside(self, blob: Blob, left_px: float) -> tuple[float, float]:
        """Returns column and row so far to the left of a blob's middle, across the ray from the picture's centre."""
        ahead_px, aside_px = self.mirror.centre_px - blob.row, self.mirror.centre_px - blob.column
        per_px = left_px / max(math.hypot(ahead_px, aside_px), 1.0)
        return blob.column - ahead_px * per_px, blob.row + aside_px * per_px

    def _in_the_air(self, blob: Blob) -> BallSighting | None:
        """Returns the ball in the air that has the size of a blob; None if place or shape do not fit."""
        radius_px = math.sqrt(blob.area_px / math.pi)
        if not self.mirror.shows_all(blob.column, blob.row, radius_px):
            return None
        x_m, y_m, z_m = centre_m = self.mirror.centre_of(blob.column, blob.row, radius_px, self.radius_m)
        near = math.hypot(x_m, y_m, z_m - self.mirror.height_m) < _NEAREST_M
        spread = blob.spread_px2 * 2 / radius_px**2
        if near or math.hypot(x_m, y_m) > self.farthest_m or not seems_whole(spread, radius_px):
            return None
        covariance_m2 = sphere_covariance(self.mirror, centre_m, area_share(spread, radius_px), self.deviation_px)
        return BallSighting(x_m, y_m, max(0.0, z_m - self.radius_m), covariance_m2, IN_THE_AIR)

    def _locate(self, column: float, row: float) -> tuple[float, float, float] | None:
        """Returns the ball on the ground whose circle has this centre: x, y (m), radius (px); None for the sky."""
        wanted = np.array([column, row])
        looked_at = wanted
        for _ in range(2):  # the centre of the circle is not quite where the ball's centre appears
            x_m, y_m = self.mirror.ground(looked_at[None], self.radius_m)[0]
            if not math.isfinite(x_m):
                return None
            *centre, radius_px = self.mirror.sphere((x_m, y_m, self.radius_m), self.radius_m)
            looked_at = looked_at + wanted - centre
        x_m, y_m = self.mirror.ground(looked_at[None], self.radius_m)[0]
        return (float(x_m), float(y_m), radius_px) if math.isfinite(x_m) else None


def _is_round(blob: Blob, radius_px: float) -> bool:
    """Returns whether a blob is as compact as a disc of this radius, apart from noise."""
    return blob.spread_px2 <= _MOST_SPREAD * radius_px**2 / 2
