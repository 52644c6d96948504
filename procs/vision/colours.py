"""Colours of the robot soccer world: as they are painted, and as ranges by which they are told apart."""

from typing import Annotated, NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo

Picture = NDArray[np.uint8]
"""Height x width x 3, blue green red."""
Mask = NDArray[np.bool_]

Bgr = tuple[int, int, int]
GREEN: Bgr = (58, 132, 52)
WHITE: Bgr = (222, 228, 224)
BLACK: Bgr = (30, 28, 28)
ORANGE: Bgr = (22, 108, 236)
CYAN: Bgr = (214, 196, 40)
MAGENTA: Bgr = (186, 48, 198)
COLOURS: dict[str, Bgr] = {"cyan": CYAN, "magenta": MAGENTA}
"""Colour of each team's markers."""
FLOOR: Bgr = (124, 120, 112)

_Level = Annotated[int, Field(ge=0, le=255)]
Hsv = tuple[Annotated[int, Field(ge=0, le=179)], _Level, _Level]
"""Hue 0..179 (half degrees), saturation and value 0..255, as OpenCV defines them."""


class ColourRange(NamedTuple):
    """A box in hue, saturation and value, both corners included."""

    low: Hsv
    high: Hsv

    def mask(self, hsv: Picture) -> Mask:
        """Returns a mask (height x width) of the pixels of this colour in a picture in HSV (height x width x 3)."""
        if not hsv.size:
            return np.zeros(hsv.shape[:2], bool)
        return np.asarray(cv2.inRange(hsv, np.array(self.low), np.array(self.high)) > 0)


def to_hsv(pixels: Picture) -> Picture:
    """Returns the picture in hue, saturation and value; it may have no pixels."""
    if not pixels.size:
        return pixels
    return np.asarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2HSV), np.uint8)


def not_below(high: Hsv, info: ValidationInfo) -> Hsv:
    """Refuses a setting `NAME_high`, the greatest values of a colour, that is below `NAME_low` in one of them."""
    low_name = str(info.field_name).removesuffix("high") + "low"
    low = info.data.get(low_name, (0, 0, 0))  # missing if it is a mistake itself
    for part, least, greatest in zip(("hue", "saturation", "value"), low, high, strict=True):
        if greatest < least:
            raise ValueError(f"{part} {greatest} is less than that of {low_name}, {least}; no colour is between them")
    return high
