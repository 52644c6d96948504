"""A blob of the ball's colour in a picture: its place and size, and the place of a disc of which it shows a part."""

from dataclasses import dataclass

import numpy as np

from procs.model.algebra import Floats, median, weighted_mean
from procs.vision.colours import ColourRange, Mask, Picture, to_hsv

_LEAST_SOLID = 0.5  # of a blob's area must be of the ball's colour; the rest is its rim
_LEAST_WARMTH = 30.0  # red minus blue, in levels of 255, above which this difference separates a ball from the rest
_FAINT = 0.15  # share of a pixel; a pixel of which the ball covers less counts as noise
_MOST_DOUBT = 0.6  # with more, neither of two discs is the likelier one

_Place = tuple[float, float]


@dataclass(frozen=True)
class Blob:
    """An area of the ball's colour, in pixels of the picture."""

    cover: Floats
    """Share (rows x columns) of each pixel, 0..1, that the ball covers."""
    columns: Floats
    """Place of each column of `cover` in the picture."""
    rows: Floats
    """The same of its rows."""
    area_px: float
    """Sum of the shares."""
    column: float
    """Middle of the area."""
    row: float
    spread_px2: float
    """Mean square distance of the area from its middle."""

    def likelier_disc(self, first: _Place, second: _Place, radius_px: float) -> tuple[int, float]:
        """Returns which of two discs is the likelier one whose visible part the blob is, and the doubt about that.

        Nothing of a blob lies outside its own disc, much of it outside one on the other side of its middle.

        Args:
            first: column and row of a disc's middle.
            second: the same of the other disc.
            radius_px: radius of both.

        Returns:
            1 for the first disc, -1 for the second, 0 if the blob does not tell, as one between two edges. The doubt
            (0..1) is what lies outside the likelier disc compared with what lies outside the other; 1 for 0.
        """
        beyond_first, beyond_second = self._beyond(first, radius_px), self._beyond(second, radius_px)
        less, more = sorted((beyond_first, beyond_second))
        if more <= 0.0 or less > _MOST_DOUBT * more:
            return 0, 1.0
        return 1 if beyond_first < beyond_second else -1, less / more

    def _beyond(self, middle: _Place, radius_px: float) -> float:
        """Returns how much of the blob lies outside a disc; what lies closely outside counts less."""
        column, row = middle
        squared_px = ((self.rows - row) ** 2)[:, None] + (self.columns - column) ** 2
        return float((self.cover * (squared_px / radius_px**2 - 1.0).clip(0.0, 1.0)).sum())


def blob_in(pixels: Picture, colour: ColourRange, left: int, top: int, right: int, bottom: int) -> Blob | None:
    """Returns the blob of the ball's colour in a part of a picture; None if too little of it is of that colour."""
    left, top = max(left, 0), max(top, 0)
    window = pixels[top:bottom, left:right]
    solid = colour.mask(to_hsv(window))
    cover = _cover(window, solid)
    area_px = float(cover.sum())
    if solid.sum() < _LEAST_SOLID * area_px:
        return None
    in_column, in_row = cover.sum(axis=0), cover.sum(axis=1)
    columns = np.arange(left, left + len(in_column), dtype=np.float64)
    rows = np.arange(top, top + len(in_row), dtype=np.float64)
    column, row = weighted_mean(columns, in_column), weighted_mean(rows, in_row)
    spread_px2 = weighted_mean((columns - column) ** 2, in_column) + weighted_mean((rows - row) ** 2, in_row)
    return Blob(cover, columns, rows, area_px, column, row, spread_px2)


def _cover(window: Picture, solid: Mask) -> Floats:
    """Returns the share of each pixel, 0..1, that the ball covers; `solid` marks the pixels of its colour.

    For an orange ball, red minus blue measures the share: this difference is close to 0 on carpet, lines and robots.
    For a ball of another colour, a pixel counts wholly or not at all.
    """
    warmth: Floats = window[..., 2].astype(np.float64) - window[..., 0]
    full = median(warmth[solid])
    if full < _LEAST_WARMTH:
        return solid.astype(np.float64)
    cover = (warmth / full).clip(0.0, 1.0)
    cover[cover < _FAINT] = 0.0
    return cover
