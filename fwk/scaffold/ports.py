"""Adds ports to the class of a component and removes them; everything else stays as it is."""

import re
from dataclasses import dataclass

import libcst as cst

from fwk.component.component import Component
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.class_lines import attributes, code_of, lines_of, taken, uses, with_line, with_lines, without
from fwk.scaffold.imports import add_import, remove_unused
from fwk.scaffold.source import Source

PORTS = {"reads": "Reads", "writes": "Writes", "serves": "Serves", "calls": "Calls"}
"""Kinds of ports, as typed, with their annotations; a component declares them in this order."""
_NAME = re.compile(r"[A-Za-z_]\w*", re.ASCII)


@dataclass(frozen=True)
class PortRequest:
    """A port to add."""

    kind: str
    """One of `PORTS`."""
    name: str
    types: tuple[str, ...]
    """Full names of its message types: `garden.ball_t`; of a service with replies: request and reply."""
    each: bool = False
    channel: str = ""
    history: int = 0


def add_port(source: Source, request: PortRequest) -> None:
    """Adds a port to the component, and the imports that it needs.

    Raises:
        ScaffoldError: the class has another attribute of that name.
    """
    kind = f"fwk.{PORTS[request.kind]}[{','.join(f'lcmtypes.{each}' for each in request.types)}]"
    meaning = f"fwk.Each[{kind}]" if request.each else kind
    if (there := attributes(source.component()).get(request.name)) is not None:
        if source.meaning(there.annotation.annotation) == meaning:
            return
        raise ScaffoldError(taken(source, there, request.name))
    _refuse_other_use(source, source.component(), request.name)
    types = [_type(source, each) for each in request.types]
    text = f"{add_import(source, 'fwk', PORTS[request.kind])}[{', '.join(types)}]"
    if request.each:
        text = f"{add_import(source, 'fwk', 'Each')}[{text}]"
    line = f"{request.name}: {text}"
    if request.channel or request.history:
        given = [f'"{request.channel}"'] if request.channel else []
        given += [f"history={request.history}"] if request.history else []
        line += f" = {add_import(source, 'fwk', 'channel')}({', '.join(given)})"
    class_ = source.component()
    source.replace(class_, with_lines(class_, with_line(source, lines_of(class_), line, list(PORTS.values()))))


def remove_port(source: Source, kind: str, name: str) -> list[str]:
    """Removes a port, if the class has it, and imports that nothing else uses.

    Returns:
        Places that still use the port, as `FILE:LINE`.

    Raises:
        ScaffoldError: the attribute of that name is not a port of that kind.
    """
    class_ = source.component()
    there = attributes(class_).get(name)
    if there is None:
        return []
    meaning = source.meaning(there.annotation.annotation)
    if not re.match(rf"(fwk\.Each\[)?fwk\.{PORTS[kind]}\b", meaning):
        raise ScaffoldError(
            f"{source.place(there)}: '{name}' of {source.class_name} is {code_of(source, there)}, not {kind}"
        )
    with_channel = "fwk.channel" if there.value is not None else ""
    source.replace(class_, with_lines(class_, without(lines_of(class_), name)))
    for full in (*re.findall(r"[\w.]+", meaning), with_channel):
        remove_unused(source, full)
    return uses(source, f"self.{name}")


def _type(source: Source, full: str) -> str:
    package, _, name = full.rpartition(".")
    return add_import(source, f"lcmtypes.{package}", name)


def _refuse_other_use(source: Source, class_: cst.ClassDef, name: str) -> None:
    """Refuses the name of a method or of a plain attribute of the class."""
    if not _NAME.fullmatch(name):
        raise ScaffoldError(f"'{name}' is not the name of a port; write one word, such as ball")
    if hasattr(Component, name):
        raise ScaffoldError(f"every component has '{name}'; choose another name")
    for line in lines_of(class_):
        if isinstance(line, cst.FunctionDef | cst.ClassDef) and line.name.value == name:
            raise ScaffoldError(
                f"{source.place(line)}: {source.class_name} has a '{name}' already; choose another name"
            )
        for each in line.body if isinstance(line, cst.SimpleStatementLine) else ():
            if isinstance(each, cst.Assign) and any(
                isinstance(target.target, cst.Name) and target.target.value == name for target in each.targets
            ):
                raise ScaffoldError(
                    f"{source.place(each)}: {source.class_name} has a '{name}' already; choose another name"
                )
