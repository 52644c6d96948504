"""Replay: runs real components again on their recorded inputs."""
