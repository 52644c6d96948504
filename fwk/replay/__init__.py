"""Replay: recorded inputs to real components, at the iterations at which they had them."""
