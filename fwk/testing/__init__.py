"""Tests of components: a bench for one component, a system in memory for many or for a launch file."""

from fwk.lcm.type_registry import use_types_of
from fwk.model.errors import PlanError
from fwk.testing.bench import Bench, program_bench
from fwk.testing.document import Document
from fwk.testing.expression import Expression, ExpressionError, reads_messages
from fwk.testing.launched import launch_plan, settings_in, system_of
from fwk.testing.memory import MemorySystem
from fwk.testing.scenario import Expectations, Verdict, Watch, play

__all__ = [
    "Bench",
    "Document",
    "Expectations",
    "Expression",
    "ExpressionError",
    "MemorySystem",
    "PlanError",
    "Verdict",
    "Watch",
    "launch_plan",
    "play",
    "program_bench",
    "reads_messages",
    "settings_in",
    "system_of",
    "use_types_of",
]
