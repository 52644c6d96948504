"""Order in which the components of a run start, and checks that it exists."""

from collections.abc import Mapping, Sequence
from itertools import pairwise

from fwk.model.errors import Problems
from fwk.model.plan import ComponentPlan, HostPlan
from fwk.plan.files.templates import Asked
from fwk.plan.wiring.needs import Needs, ring


def start_order(components: Sequence[ComponentPlan], chosen: Sequence[int]) -> list[int]:
    """Returns components, by index, each after those that it needs, otherwise in the given order."""
    order: dict[int, None] = {}

    def put(index: int) -> None:
        if index not in order:
            for needed in components[index].needs:
                if needed in chosen:
                    put(needed)
            order[index] = None

    for index in chosen:
        put(index)
    return list(order)


def check_starts(asked: Sequence[Asked], needs: Needs, problems: Problems) -> None:
    """Refuses a component that starts with the run and needs one that does not."""
    later = {each.name for each in asked if not each.entry.start}
    for each in asked:
        for name in needs.get(each.name, ()):
            if name in later and each.name not in later:
                text = f"it starts with the run and needs '{name}', which does not"
                right = "set 'start: false' here too, or remove it there"
                problems.add(each.node.at("needs").place, each.name, f"{text}; {right}")


def check_groups(
    asked: Sequence[Asked], groups: Mapping[str, str], places: Mapping[str, str], problems: Problems
) -> None:
    """Refuses processes of which only some components start with the run."""
    first: dict[str, Asked] = {}
    for each in asked:
        if each.name in groups:
            other = first.setdefault(groups[each.name], each)
            if other.entry.start != each.entry.start:
                names = f"{other.name} and {each.name}"
                text = f"{names} share a process and only one starts with the run; set 'start' alike for both"
                problems.add(places[groups[each.name]], "", text)


def check_processes(
    hosts: Sequence[HostPlan], components: Sequence[ComponentPlan], asked: Sequence[Asked], problems: Problems
) -> None:
    """Refuses processes that wait for each other, because they would never start."""
    between: Needs = {}
    because: dict[tuple[str, str], str] = {}
    for component in components:
        for needed in component.needs:
            one, other = hosts[component.host].name, hosts[components[needed].host].name
            if one != other:
                between.setdefault(one, []).append(other)
                because.setdefault((one, other), f"{component.name} needs {components[needed].name}")
    if around := ring(between):
        why = "; ".join(because[pair] for pair in pairwise(around))
        who = because[around[0], around[1]].partition(" needs ")[0]
        place = next(each.node.at("needs").place for each in asked if each.name == who)
        text = f"processes need each other in a cycle: {' -> '.join(around)} ({why}); group the components differently"
        problems.add(place, who, text)
