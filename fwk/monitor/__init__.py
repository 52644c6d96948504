"""Monitors: a few lines of the user that see chosen messages of a run or of a log."""
