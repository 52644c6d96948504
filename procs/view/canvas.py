"""A picture with a scale: draws smoothed shapes, given in metres of the world frame, to fractions of a pixel."""

import math
from collections.abc import Sequence

import cv2
import numpy as np

from procs.vision.colours import Picture

Colour = tuple[int, int, int]
"""Blue, green, red."""
Place = tuple[float, float]
"""x and y in metres, world frame."""

_SHIFT = 4  # OpenCV takes coordinates in sixteenths of a pixel
_FAR_PX = 20_000.0  # coordinates are limited to this
_FONT = cv2.FONT_HERSHEY_DUPLEX
_FONT_HEIGHT_PX = 21  # of a capital letter at scale 1


class Canvas:
    """Draws into `picture`; x points right and y up, and the origin of the world frame lies at `origin_px`."""

    def __init__(self, picture: Picture, origin_px: tuple[float, float], px_per_m: float) -> None:
        self.picture = picture
        self.px_per_m = px_per_m
        self._origin_px = origin_px

    def on(self, picture: Picture) -> "Canvas":
        """Returns a canvas of the same scale on another picture."""
        return Canvas(picture, self._origin_px, self.px_per_m)

    def disc(self, place: Place, radius_m: float, colour: Colour) -> None:
        """Draws a filled circle."""
        radius = max(1, self._fine(radius_m * self.px_per_m))
        cv2.circle(self.picture, self._pixel(place), radius, colour, cv2.FILLED, cv2.LINE_AA, _SHIFT)

    def ring(self, place: Place, radius_m: float, width_m: float, colour: Colour) -> None:
        """Draws the outline of a circle; `width_m` is that of the line."""
        radius = self._fine(radius_m * self.px_per_m)
        cv2.circle(self.picture, self._pixel(place), radius, colour, self._width(width_m), cv2.LINE_AA, _SHIFT)

    def line(self, start: Place, end: Place, width_m: float, colour: Colour) -> None:
        """Draws a straight line."""
        width = self._width(width_m)
        cv2.line(self.picture, self._pixel(start), self._pixel(end), colour, width, cv2.LINE_AA, _SHIFT)

    def polyline(self, places: Sequence[Place], width_m: float, colour: Colour) -> None:
        """Draws straight lines from place to place."""
        points = np.array([self._pixel(place) for place in places], np.int32)
        cv2.polylines(self.picture, [points], False, colour, self._width(width_m), cv2.LINE_AA, _SHIFT)

    def polygon(self, places: Sequence[Place], colour: Colour) -> None:
        """Draws a filled polygon."""
        points = np.array([self._pixel(place) for place in places], np.int32)
        cv2.fillPoly(self.picture, [points], colour, cv2.LINE_AA, _SHIFT)

    def ellipse(self, place: Place, axes_m: tuple[float, float], angle_deg: float, colour: Colour) -> None:
        """Draws the outline of an ellipse, one pixel wide; the first half axis lies at `angle_deg` from x."""
        axes = (self._fine(axes_m[0] * self.px_per_m), self._fine(axes_m[1] * self.px_per_m))
        cv2.ellipse(self.picture, self._pixel(place), axes, -angle_deg, 0, 360, colour, 1, cv2.LINE_AA, _SHIFT)

    def text(self, words: str, place: Place, height_m: float, colour: Colour) -> None:
        """Writes words with their middle at `place`; `height_m` is that of a capital letter."""
        x, y = self._pixel(place)
        middle = (x / (1 << _SHIFT), y / (1 << _SHIFT))
        write(self.picture, words, middle, height_m * self.px_per_m, colour)

    def _pixel(self, place: Place) -> tuple[int, int]:
        x_px = self._origin_px[0] + place[0] * self.px_per_m
        y_px = self._origin_px[1] - place[1] * self.px_per_m
        return self._fine(x_px), self._fine(y_px)

    def _width(self, width_m: float) -> int:
        return max(1, round(width_m * self.px_per_m))

    @staticmethod
    def _fine(pixels: float) -> int:
        """Returns OpenCV's fixed-point number, which has a limited size; NaN and infinity lie far off the picture."""
        near = min(_FAR_PX, max(-_FAR_PX, pixels)) if math.isfinite(pixels) else -_FAR_PX
        return round(near * (1 << _SHIFT))


def write(
    picture: Picture, words: str, middle_px: tuple[float, float], height_px: float, colour: Colour, align: float = 0.5
) -> None:
    """Writes words into a picture; `align` is the share of their length that lies left of `middle_px`."""
    scale = height_px / _FONT_HEIGHT_PX
    thickness = max(1, round(scale * 1.4))
    (width_px, _), _ = cv2.getTextSize(words, _FONT, scale, thickness)
    corner = (round(middle_px[0] - align * width_px), round(middle_px[1] + height_px / 2))
    cv2.putText(picture, words, corner, _FONT, scale, colour, thickness, cv2.LINE_AA)
