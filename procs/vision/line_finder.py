"""Finds points on white lines: where a scan line goes from green over white to green again."""

from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats, Indices
from procs.vision.colours import ColourRange, Mask, Picture
from procs.vision.scan import Scan, runs

_BESIDE = np.array([1, 2, 3])  # samples looked at on both sides of the white ...
_GREEN_BESIDE = 2  # ... and how many of them must be green: at an edge, a real camera shows one of a mixed colour


@dataclass(frozen=True)
class LineFinder:
    """Finds green-white-green transitions, as Fawkes and the Tribots do for their localization."""

    green: ColourRange
    white: ColourRange
    widest_m: float = 0.4
    """A longer stretch of white is not a crossing of a line."""
    narrowest_m: float = 0.05
    """A shorter stretch of white is a speck, unless the pixels there are too coarse to tell."""

    def find(self, hsv: Picture, scan: Scan) -> Floats:
        """Returns the points (n, 2) on white lines, robot frame, from a scan (lines, samples, 3) in HSV.

        They come scan line by scan line.
        """
        green = self.green.mask(hsv)
        lines, starts, ends = runs(self.white.mask(hsv))
        inner, outer = scan.ground_m[lines, starts], scan.ground_m[lines, ends - 1]
        width_m = np.hypot(*(outer - inner).T)
        pixel_m = np.hypot(*(inner - scan.ground_m[lines, np.maximum(starts - 1, 0)]).T)
        line_like = (width_m <= self.widest_m) & (width_m + 2 * pixel_m >= self.narrowest_m)
        before = _count(green, lines, starts[:, None] - _BESIDE)
        after = _count(green, lines, ends[:, None] - 1 + _BESIDE)
        found = line_like & (before >= _GREEN_BESIDE) & (after >= _GREEN_BESIDE)
        return np.asarray((inner[found] + outer[found]) / 2)


def _count(mask: Mask, lines: Indices, samples: Indices) -> Indices:
    """Returns how many of the `samples` (n, k) on the scan lines (n) a mask (lines, samples) marks."""
    inside = (samples >= 0) & (samples < mask.shape[1])
    marked = mask[lines[:, None], samples.clip(0, mask.shape[1] - 1)] & inside
    return np.asarray(marked.sum(axis=1))
