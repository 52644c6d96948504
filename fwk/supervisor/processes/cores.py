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
    namespaces = [plan.components[each.components[0]].namespace for each in plan.hosts]
    distinct = list(dict.fromkeys(namespaces))
    if plan.cores != "namespace" or plan.clock == "wall" or len(distinct) < 2:
        return None
    return allowed[distinct.index(namespaces[host]) % len(allowed)]


def stay_on_core(plan: Plan, host: int) -> None:
    """Binds this process, which is that of a host, to the host's processor."""
    with suppress(OSError):  # no system's permission: the host runs anywhere
        core = core_of(plan, host, sorted(os.sched_getaffinity(0)))
        if core is not None:
            os.sched_setaffinity(0, {core})
