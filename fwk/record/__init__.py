"""Recordings: LCM logs written, read, compared, described and drawn."""
