"""Reasons in the history of a match that are commands by hand, with the names of the RefBox."""

REPAIR, SUBSTITUTION, PARK = "repair", "substitution", "park"
OFF_FIELD = frozenset({REPAIR, SUBSTITUTION, PARK})
"""A robot leaves the field without a card; `park` takes all of them off."""
RESET = "reset"
"""The match begins anew, with this whistle."""
