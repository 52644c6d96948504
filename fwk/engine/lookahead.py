"""Lookahead: stages that a host may run on the marks of an earlier stage, because nothing that it reads can change.

The rule is the conservative one of parallel discrete event simulation (Chandy and Misra 1979): a process goes on
without waiting as long as no other process can still send it something for the time in question.
"""

from itertools import pairwise

from fwk.model.plan import NOBODY, HostPlan, Plan

Lookahead = dict[int, int]
"""Each stage of a host with the last stage that the host may run on the marks of that stage's tick."""


def lookahead(plan: Plan) -> list[Lookahead]:
    """Returns the lookahead of each host of a plan, by index.

    A host goes on from one of its stages to its next one if no other host writes, in that stage or in one between
    them, a channel that the host reads. It holds for the plan's schedule, in lockstep, and without dynamic channels.
    """
    return [_of_host(plan, host) for host in plan.hosts]


def _of_host(plan: Plan, host: HostPlan) -> Lookahead:
    own = set(host.components)
    stages = sorted({stage for index in own for stage in plan.components[index].stages})
    last = {stage: stage for stage in stages}
    writers = {channel.writer for channel in plan.channels if not own.isdisjoint(channel.readers)} - own - {NOBODY}
    if plan.clock == "wall" or plan.spare_channels or _shows_frames(plan, own) or _is_any_continuous(plan, writers):
        return last
    changing = {stage for writer in writers for stage in plan.components[writer].stages}
    for stage, following in reversed(list(pairwise(stages))):
        if changing.isdisjoint(range(stage, following)):
            last[stage] = last[following]
    return last


def _shows_frames(plan: Plan, own: set[int]) -> bool:
    """Returns whether another host looks at frames of this one: they must stay in their ring until it has run."""
    cameras = (channel for channel in plan.channels if channel.images and channel.writer in own)
    return any(not own.issuperset(channel.readers) for channel in cameras)


def _is_any_continuous(plan: Plan, components: set[int]) -> bool:
    """Returns whether the marks of any of these components move at any time."""
    return any(plan.components[index].rate_hz is not None for index in components)
