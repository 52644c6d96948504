"""Tests of components: a bench for one component, a system in memory for many or for a launch file."""

from fwk.testing.bench import Bench
from fwk.testing.launched import launch_plan, settings_in, system_of
from fwk.testing.memory import MemorySystem

__all__ = ["Bench", "MemorySystem", "launch_plan", "settings_in", "system_of"]
