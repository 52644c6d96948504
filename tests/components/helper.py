"""A plain module that a component imports."""

ADDED = 1.0
