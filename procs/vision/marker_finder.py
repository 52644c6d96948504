"""Recognizes the teams of robots by the colour of their markers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats
from procs.model.rays import left_of, rays
from procs.model.robot import ROBOT
from procs.vision.colours import ColourRange, Picture, to_hsv
from procs.vision.mirror import Mirror

_UP = np.repeat((0.25, 0.5, 0.75), 3)  # heights of the samples, as shares of the way up from the marker's lower edge
_ACROSS = np.tile((-0.4, 0.0, 0.4), 3)  # places of the samples across the body, as shares of its radius
_LEAST = 0.5  # share of the samples that must have the colour


@dataclass(frozen=True)
class MarkerFinder:
    """Looks for the colours of the teams on round robots of known radius."""

    mirror: Mirror
    colours: tuple[ColourRange, ...]
    """Colour of the markers of each team, in the order of the teams' numbers."""
    radius_m: float = ROBOT.radius_m
    marker_m: tuple[float, float] = ROBOT.marker_m
    """Heights of the lower and the upper edge of the markers."""

    def find(self, pixels: Picture, places_m: Sequence[tuple[float, float]]) -> list[int]:
        """Returns the team of each robot: the number of its colour, counted from 1, or 0 if no marker is seen.

        Args:
            pixels: picture, height x width x 3.
            places_m: middles of the robots, robot frame.
        """
        if not places_m:
            return []
        samples = self._samples(np.array(places_m))
        places_px = np.rint(self.mirror.project(samples.reshape(-1, 3))).astype(int)
        columns, rows = np.minimum(np.maximum(places_px, 0), self.mirror.size_px - 1).T
        hsv = to_hsv(pixels[rows, columns].reshape(len(places_m), -1, 3))
        shares = np.stack([np.zeros(len(places_m)), *(colour.mask(hsv).mean(axis=1) for colour in self.colours)])
        shares[0] = _LEAST
        return [int(team) for team in shares.argmax(axis=0)]

    def _samples(self, places_m: Floats) -> Floats:
        """Returns points (robots, samples, 3) on the sides of the robots that face the camera."""
        _, ahead = rays(places_m)
        near_m = places_m - ahead * self.radius_m
        points = np.empty((len(places_m), len(_ACROSS), 3))
        points[:, :, :2] = near_m[:, None] + (_ACROSS * self.radius_m)[:, None] * left_of(ahead)[:, None]
        lower_m, upper_m = self.marker_m
        points[:, :, 2] = lower_m + _UP * (upper_m - lower_m)
        return points
