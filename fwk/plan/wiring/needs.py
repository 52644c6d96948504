"""Needs of components: those of the launch file and those of granted aspects, without cycles."""

from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

from fwk.model.errors import Problems
from fwk.model.plan import NOBODY
from fwk.model.selection import matches, nearest
from fwk.plan.files.launch_file import Files
from fwk.plan.files.source import Node
from fwk.plan.files.templates import Asked
from fwk.plan.wiring.component_spec import ComponentSpec
from fwk.plan.wiring.wiring import Wiring

Needs = dict[str, list[str]]
"""Component to the components it needs."""


def granted_by(specs: Sequence[ComponentSpec], wiring: Wiring) -> Needs:
    """Returns the components that grant each component an aspect: providers, and vision masters of its images."""
    found: Needs = {
        spec.name: list(granted.values()) for spec, granted in zip(specs, wiring.granted, strict=True) if granted
    }
    for spec, ports in zip(specs, wiring.ports, strict=True):
        images = {name for port in spec.declaration.ports if port.kind == "image" for name in ports[port.attribute]}
        for channel in wiring.channels:
            if channel.name in images and channel.writer != NOBODY:
                found.setdefault(spec.name, []).append(specs[channel.writer].name)
    return found


def needs_of(asked: Sequence[Asked], granted: Needs, files: Files, problems: Problems) -> Needs:
    """Returns the needs of each component: those of the files, and the components that grant it an aspect."""
    said = _said(asked, files, problems)
    needs = {name: [*said.get(name, ()), *granted.get(name, ())] for name in {**said, **granted}}
    if around := ring(needs):
        place = next(each.node.at("needs").place for each in asked if each.name == around[0])
        avoidable = any(other in said.get(name, ()) for name, other in pairwise(around))
        right = "leave one 'needs' out" if avoidable else "let one do without what another provides"
        problems.add(place, around[0], f"components need each other in a cycle: {' -> '.join(around)}; {right}")
    return {name: list(dict.fromkeys(others)) for name, others in needs.items()}


def check_left_out(
    names: Sequence[str], kept: Collection[str], granted: Needs, without: Sequence[str], problems: Problems
) -> None:
    """Refuses a selection that leaves out a component which grants an aspect to a selected one."""
    for name in names:
        for other in granted.get(name, ()):
            if name in kept and other not in kept:
                option = "--without" if any(matches(other, pattern) for pattern in without) else "--only"
                problems.add(option, name, f"it cannot do without {other}, which is left out; leave out both or none")


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
                text = f"it needs '{name}', which does not exist; {nearest(name, names)}"
                problems.add(node.at(number).place, each.name, text)
    return needs


def ring(needs: Mapping[str, Sequence[str]]) -> list[str]:
    """Returns a cycle of components that wait for each other, first and last the same; empty if there is none."""
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
