"""The ball of the middle size league: a football of size 5 on short carpet."""

RADIUS_M = 0.11
MASS_KG = 0.43
SLIDING_M_S2 = 3.0
"""Deceleration while the ball slides, as it does after a kick."""
ROLLING_M_S2 = 0.4
"""Deceleration while it rolls."""
INERTIA = 2 / 3
"""Moment of inertia divided by mass and squared radius: 2/3 for a thin shell."""
ROLLING_SHARE = 1 / (1 + INERTIA)
"""Share of a kick's speed that is left when the ball begins to roll."""
