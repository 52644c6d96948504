"""Replay: recorded inputs to real components, at the iterations that had them."""
