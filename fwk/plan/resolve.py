"""Resolves the components of a launch file: their classes, stages, settings and needs."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

from fwk.component.child_process import missing_program
from fwk.component.declaration import Declaration
from fwk.model.errors import Problems, hint
from fwk.model.selection import dot_for_slash, matches, nearest
from fwk.plan.classes import UnusableError, find_class
from fwk.plan.files.launch_file import Files
from fwk.plan.files.overrides import SHARED
from fwk.plan.files.settings import effective
from fwk.plan.files.source import Node
from fwk.plan.files.substitution import substitute
from fwk.plan.files.templates import Asked
from fwk.plan.stages import stages_in
from fwk.plan.turns import split_turns, turns_of
from fwk.plan.wiring.component_spec import ComponentSpec


@dataclass(frozen=True)
class Resolved:
    """A component with everything that does not depend on other components."""

    asked: Asked
    declaration: Declaration
    stages: tuple[int, ...]
    config: dict[str, Any]
    origins: dict[str, str]
    every: int
    offset: int

    @property
    def rate_hz(self) -> float | None:
        """Rate of a continuous component, in Hz; None for a component with stages."""
        said = self.asked.entry.rate_hz
        return self.declaration.rate_hz if said is None or self.declaration.rate_hz is None else said

    @property
    def spec(self) -> ComponentSpec:
        """The component as wiring needs it."""
        channels = self.asked.node.child("channels")
        said = {port: str(name) for port, name in channels.plain().items()} if channels else {}
        providers = self.asked.node.child("providers")
        return ComponentSpec(self.asked.name, self.declaration, said, providers.plain() if providers else {})

    def place(self, port: str | None) -> str:
        """Returns the place of a port's channel in the files; by default the place of the component."""
        return self.asked.node.at("channels", port).place if port and self._says(port) else self.asked.node.place

    def _says(self, port: str) -> bool:
        return self.asked.node.at("channels").child(port) is not None


def add_settings(files: Files, components: Sequence[Asked], problems: Problems) -> None:
    """Adds the settings of the `config:` sections, which name components by patterns."""
    names = [asked.name for asked in components]
    for number, layer in enumerate(files.layers):
        for pattern in layer.content.config:
            node = layer.node.at("config", pattern)
            meant = [asked for asked in components if matches(asked.name, pattern)]
            if not meant and not files.may_hide(pattern):
                right = (
                    f"write '{SHARED}:' beside 'config:', not in it" if pattern == SHARED else nearest(pattern, names)
                )
                problems.add(node.place, "", f"no component '{pattern}'; {right}")
            if isinstance(node.value, dict) and (wrong := dot_for_slash(pattern, node.value, names)):
                problems.add(node.place, "", wrong)
                continue
            for asked in meant:
                filled = substitute(node, asked.values, partial(_report, problems, asked.name))
                if filled:
                    asked.config.append((number, filled))


def _report(problems: Problems, who: str, place: str, text: str) -> None:
    problems.add(place, who, text)


def resolve(
    files: Files, components: Sequence[Asked], stages: Sequence[str], folders: Sequence[str], problems: Problems
) -> list[Resolved]:
    """Finds the classes and merges the settings; components without a usable class are reported and left out."""
    classes: dict[str, Declaration | str] = {}
    found = []
    for asked in components:
        use = asked.entry.use
        if use not in classes:
            classes[use] = _class_or_reason(use, folders)
        declared = classes[use]
        if isinstance(declared, str):
            problems.add(asked.node.at("use").place, asked.name, declared)
            files.gaps.add(asked.namespace)
            continue
        report = partial(_report, problems, asked.name)
        if asked.entry.command and (missing := missing_program(asked.entry.command, folders)):
            report(asked.node.at("command").place, missing)
        _add_shared(files, asked, declared, report)
        layers, turns = split_turns(asked, declared, problems)
        config, origins = effective(declared.config, layers, asked.node.place, report)
        _check_ports(asked, declared, problems)
        indices = stages_in(asked, declared, stages, problems)
        every, offset = turns_of(asked, declared, turns, problems)
        found.append(Resolved(asked, declared, indices, config, origins, every, offset))
    _check_time_sources(found, problems)
    _check_shared(files, found, problems)
    return found


def _add_shared(files: Files, asked: Asked, declared: Declaration, report: Callable[[str, str], None]) -> None:
    """Puts the settings of the `shared:` sections that the class has before the others of the same file."""
    for number, layer in reversed(list(enumerate(files.layers))):
        known = (name for name in layer.content.shared if name in declared.config.model_fields)
        kept = {name: layer.node.at("shared", name) for name in known}
        if kept and (filled := substitute(Node(kept, layer.node.at("shared").place), asked.values, report)):
            asked.config.insert(0, (number, filled))


def _check_shared(files: Files, found: Sequence[Resolved], problems: Problems) -> None:
    """Reports shared settings that no component has."""
    known = {name for each in found for name in each.declaration.config.model_fields}
    for layer in files.layers:
        for name in layer.content.shared:
            if name not in known and not files.gaps:
                place = layer.node.at("shared", name).place
                problems.add(place, "", f"no component has a setting '{name}'; {hint(name, sorted(known))}")


def _class_or_reason(use: str, folders: Sequence[str]) -> Declaration | str:
    try:
        return find_class(use, folders)
    except UnusableError as error:
        return str(error)


def _check_ports(asked: Asked, declared: Declaration, problems: Problems) -> None:
    known = [port.attribute for port in declared.ports]
    for port in asked.entry.channels:
        if port not in known:
            node = asked.node.at("channels", port)
            problems.add(node.place, asked.name, f"no port '{port}'; {nearest(port, known)}")


def check_clock(found: Sequence[Resolved], clock: str, problems: Problems) -> None:
    """Refuses `clock: wall` beside a component that is a time source."""
    for owner in found if clock == "wall" else ():
        if "time_source" in owner.declaration.aspects.values():
            name = owner.asked.name
            text = f"two time sources: the wall clock (clock: wall) and {name}; keep one, or set 'clock: simulated'"
            problems.add(owner.asked.node.place, name, text)


def _check_time_sources(found: Sequence[Resolved], problems: Problems) -> None:
    owners = [each for each in found if "time_source" in each.declaration.aspects.values()]
    for other in owners[1:]:
        first = owners[0].asked
        text = f"two time sources: {first.name} ({first.node.place}) and {other.asked.name}; keep one"
        problems.add(other.asked.node.place, other.asked.name, text)
