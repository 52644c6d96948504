"""Units of time, and headings in radians."""

import math

US_PER_S = 1_000_000
"""Microseconds in a second."""
_TURN_RAD = 2 * math.pi


def heading_mistake(heading_rad: float) -> str:
    """Returns why a file should not state a heading, or an empty text; more than a turn is most likely in degrees."""
    right = f"it should be from {-_TURN_RAD:.2f} to {_TURN_RAD:.2f}, in radians"
    return "" if abs(heading_rad) < _TURN_RAD + 0.01 else f"heading_rad is {heading_rad:g}; {right}"
