"""For tests of components: a bench for one, a system in memory for many."""

from fwk.testing.bench import Bench
from fwk.testing.memory import MemorySystem

__all__ = ["Bench", "MemorySystem"]
