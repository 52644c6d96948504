"""Recordings: writing, comparing, describing and drawing them."""
