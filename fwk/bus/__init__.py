"""Sockets of a run: sending, receiving, waiting, the public bus and port locks."""
