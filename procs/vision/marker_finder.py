"""Tells the teams of robots apart by the colour of their markers."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats
from procs.model.robot import ROBOT
from procs.vision.colours import ColourRange, Picture, to_hsv
from procs.vision.mirror import Mirror

_HEIGHTS_M = (0.38, 0.42, 0.46)  # of the samples; the rules have markers at these heights
_BESIDE = (-0.4, 0.0, 0.4)  # places of the samples across the body, as shares of its radius
_LEAST = 0.5  # share of the samples that must have the colour


@dataclass(frozen=True)
class MarkerFinder:
    """Looks for the colours of the teams on round robots of known radius."""

    mirror: Mirror
    colours: tuple[ColourRange, ...]
    """One for each team."""
    radius_m: float = ROBOT.radius_m

    def find(self, pixels: Picture, places_m: Sequence[tuple[float, float]]) -> list[int]:
        """Returns the team of each robot: the number of its colour, counted from 1, or 0 if none is seen.

        Args:
            pixels: picture, height x width x 3.
            places_m: middles of the robots, robot frame.
        """
        if not places_m:
            return []
        samples = self._samples(np.array(places_m))
        rows, columns = (
            np.rint(self.mirror.project(samples.reshape(-1, 3))).astype(int).clip(0, self.mirror.size_px - 1).T[::-1]
        )
        hsv = to_hsv(pixels[rows, columns].reshape(len(places_m), -1, 3))
        shares = np.stack([np.zeros(len(places_m)), *(colour.mask(hsv).mean(axis=1) for colour in self.colours)])
        shares[0] = _LEAST
        return [int(team) for team in shares.argmax(axis=0)]

    def _samples(self, places_m: Floats) -> Floats:
        """Returns points (robots, samples, 3) on the sides of the robots that face the camera."""
        ranges_m = np.maximum(np.hypot(places_m[:, 0], places_m[:, 1]), 1e-6)[:, None]
        ahead = places_m / ranges_m
        aside = np.column_stack((-ahead[:, 1], ahead[:, 0]))
        near_m = places_m - ahead * self.radius_m
        points = [
            np.column_stack((near_m + beside * self.radius_m * aside, np.full(len(places_m), height_m)))
            for height_m in _HEIGHTS_M
            for beside in _BESIDE
        ]
        return np.stack(points, axis=1)
