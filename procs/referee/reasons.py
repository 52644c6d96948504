"""Reasons in the history of a match that are commands by hand, with the names of the RefBox."""

REPAIR, SUBSTITUTION, PARK = "repair", "substitution", "park"
REPAIRS = (REPAIR, SUBSTITUTION)
"""One robot leaves the field without a card."""
OFF_FIELD = frozenset({*REPAIRS, PARK})
"""The same, or all robots with `park`."""
RESET = "reset"
"""The match begins anew, with this whistle."""
