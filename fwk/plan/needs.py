"""The order in which components start: who needs whom, and the ring that must not be in it."""

from collections.abc import Mapping, Sequence

from fwk.plan.errors import Problems
from fwk.plan.expand import Asked
from fwk.plan.files import Files
from fwk.plan.model import NOBODY
from fwk.plan.resolve import Resolved
from fwk.plan.selection import nearest
from fwk.plan.source import Node
from fwk.plan.wiring import Wiring

Needs = dict[str, list[str]]
"""Component to the components it needs."""


def needs_of(
    asked: Sequence[Asked], components: Sequence[Resolved], wiring: Wiring, files: Files, problems: Problems
) -> Needs:
    """Who needs whom: as the files say, and whoever looks at images needs their camera."""
    needs = _said(asked, files, problems)
    for each, ports in zip(components, wiring.ports, strict=True):
        looked_at = {name for port in each.declaration.ports if port.kind == "image" for name in ports[port.attribute]}
        for channel in wiring.channels:
            if channel.name in looked_at and channel.writer != NOBODY:
                needs.setdefault(each.asked.name, []).append(components[channel.writer].asked.name)
    if around := ring(needs):
        place = next(each.node.at("needs").place for each in asked if each.name == around[0])
        text = f"components need each other in a ring: {' -> '.join(around)}; leave one 'needs' out"
        problems.add(place, around[0], text)
    return {name: list(dict.fromkeys(others)) for name, others in needs.items()}


def _said(asked: Sequence[Asked], files: Files, problems: Problems) -> Needs:
    names = [each.name for each in asked]
    needs: Needs = {}
    for each in asked:
        node = each.node.child("needs") or Node([], each.node.place)
        for number, written in enumerate(node.plain() if isinstance(node.value, list) else [node.value]):
            name = f"{each.namespace}/{written}" if "/" not in str(written) and each.namespace else str(written)
            if name in names:
                needs.setdefault(each.name, []).append(name)
            elif not files.may_hide(name):
                text = f"it needs '{name}', which is not there; {nearest(name, names)}"
                problems.add(node.at(number).place, each.name, text)
    return needs


def ring(needs: Mapping[str, Sequence[str]]) -> list[str]:
    """A ring of components that wait for each other, first and last the same; empty if there is none."""
    done: set[str] = set()
    for start in needs:
        found = _from(start, needs, done, [])
        if found:
            return found
    return []


def _from(name: str, needs: Mapping[str, Sequence[str]], done: set[str], way: list[str]) -> list[str]:
    if name in way:
        return [*way[way.index(name) :], name]
    if name not in done:
        for other in needs.get(name, ()):
            found = _from(other, needs, done, [*way, name])
            if found:
                return found
        done.add(name)
    return []
