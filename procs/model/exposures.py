"""Times of exposures, as messages state them."""

AHEAD_S = 0.02
"""Clocks of cameras may be ahead by this much; an exposure further in the future is none."""
