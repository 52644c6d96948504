"""Processors of hosts: those of a namespace share one if the plan says so.

The messages of a robot go from one of its processes to the next. On one processor they stay in its cache, and Linux
need not move the processes of a hundred hosts between processors in each stage.
"""

import os
from contextlib import suppress

from fwk.model.plan import Plan


def core_of(plan: Plan, host: int, allowed: list[int]) -> int | None:
    """Returns the processor on which a host stays; None if it may use all that are allowed.

    In real time no processor is given: where another program is busy, half of a system would be late.
    """
    if plan.cores != "namespace" or plan.clock == "wall":
        return None
    namespaces = [plan.components[each.components[0]].namespace for each in plan.hosts]
    distinct = list(dict.fromkeys(namespaces))
    return allowed[distinct.index(namespaces[host]) % len(allowed)] if len(distinct) > 1 else None


def stay_on_core(core: int | None) -> None:
    """Binds this process to a processor, if one is given and the system permits it."""
    if core is not None:
        with suppress(OSError):
            os.sched_setaffinity(0, {core})
