"""Fixtures of the system tests."""

from tests.harness.fixtures import folder, launch, orchestra_types

__all__ = ["folder", "launch", "orchestra_types"]
