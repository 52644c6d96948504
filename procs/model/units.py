"""Units of time."""

US_PER_S = 1_000_000
"""Microseconds in a second."""
