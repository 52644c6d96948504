"""Components whose messages differ, each with its first difference and what may make it differ."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any

from fwk.model.plan import Plan
from fwk.recording.causes import Cause, causes
from fwk.recording.difference import Difference

_CAUSES_SHOWN = 5


@dataclass
class Differing:
    """A component whose messages differ."""

    component: str
    """Name; of a log without plan and headers the channel."""
    first: Difference
    differences: int = 0
    channels: set[str] = field(default_factory=set)
    causes: list[Cause] = field(default_factory=list)
    """Lines of its code that may make it differ from run to run."""

    def plain(self) -> dict[str, Any]:
        """Returns the values for JSON."""
        first = {"channel": self.first.channel, "tick": self.first.tick, "text": str(self.first)}
        found = [str(cause) for cause in self.causes]
        return {"component": self.component, "differences": self.differences, "first": first, "causes": found}


def differing(differences: Iterable[Difference], plan: Plan | None) -> list[Differing]:
    """Returns all components with differences; the one that differs first comes first.

    Args:
        differences: the differences, in any order.
        plan: plan of the run, whose modules are searched for causes; None: the log has none.
    """
    found: dict[str, Differing] = {}
    for each in sorted(differences, key=lambda difference: difference.key):
        name = component_of(each, plan)
        row = found.setdefault(name, Differing(name, each))
        row.differences += 1
        row.channels.add(each.channel)
    modules = {each.name: each.module for each in plan.components} if plan else {}
    files = {name: module.file for name, module in plan.modules.items()} if plan else {}
    for name, row in found.items():
        row.causes = causes(modules[name], files) if name in modules else []
    return list(found.values())


def component_of(difference: Difference, plan: Plan | None) -> str:
    """Returns the writer of the message; that of a dynamic channel stands in the header."""
    for channel in plan.channels if plan else ():
        if channel.name == difference.channel and channel.writer >= 0 and plan:
            return plan.components[channel.writer].name
    return difference.writer.partition("#")[0] or difference.channel


def lines_of(rows: Iterable[Differing]) -> Iterator[str]:
    """Yields the components and their causes as lines of text."""
    rows = list(rows)
    if len(rows) > 1:
        yield f"{len(rows)} components differ, in this order:"
        for row in rows:
            since = "" if row.first.tick is None else f", from tick {row.first.tick} on"
            yield f"  {row.component}: {', '.join(sorted(row.channels))}{since}"
    for row in rows:
        if row.causes:
            yield f"{row.component} may differ from run to run:"
            yield from (f"  {cause}" for cause in row.causes[:_CAUSES_SHOWN])
