"""`fwk add` and `fwk remove`: edit the class of a component."""

import json
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fwk.cli.output import say
from fwk.cli.project.changing import explaining
from fwk.program import notice
from fwk.scaffold.changes import Change, ScaffoldError, write
from fwk.scaffold.project import Project, project_at
from fwk.scaffold.types import check_port_types

if TYPE_CHECKING:
    from fwk.scaffold.source import Source

_COMPONENT_HELP = "module of the component, with :Class where it has several"
ComponentWord = Annotated[str, typer.Argument(metavar="COMPONENT", help=_COMPONENT_HELP)]
PortWords = Annotated[list[str], typer.Argument(metavar="PORT:TYPE...", help="ports, such as ball:garden.ball_t")]
ServiceWords = Annotated[
    list[str], typer.Argument(metavar="PORT:TYPE[,REPLY]...", help="services, such as kick:play.kick_t")
]
Names = Annotated[list[str], typer.Argument(metavar="NAME...", help="names to remove")]
EachFlag = Annotated[bool, typer.Option("--each", help="one for every namespace: Each[...]")]
Channel = Annotated[str, typer.Option(metavar="NAME", help="channel, where it is not named like the port")]
History = Annotated[int, typer.Option(min=0, metavar="N", help="keep the newest N messages")]
"""Options and arguments that several of the commands have."""
Meaning = Annotated[str, typer.Option(metavar="TEXT", help="meaning and unit of the setting, as its docstring")]


def open_source(component: str) -> "tuple[Project, Source]":
    """Returns the project around the current folder and the source of one of its components.

    Raises:
        ScaffoldError: there is no such component, or the library that edits is not installed.
    """
    try:
        from fwk.scaffold.source import Source, find_source
    except ImportError as error:  # missing, or broken
        raise ScaffoldError("editing components needs libcst; type: pip install 'fwk[new]'") from error
    project = project_at(Path.cwd())
    return project, Source(*find_source(project, component))


def finish(source: "Source", dry_run: bool, as_json: bool, used: Sequence[str] = ()) -> None:
    """Writes an edited source, prints the difference, and names places that need the user."""
    made = Change(source.path, source.module.code, source.text)
    if made.after != made.before and not dry_run:
        write([made])
    if as_json:
        row = {"dry_run": dry_run, "path": str(made.path), "diff": made.diff(), "still_used": [*used]}
        say(json.dumps(row, indent=2))
        return
    say(made.diff().rstrip("\n") or "nothing to do: the component is as it should be")
    if used:
        notice(f"still used: {', '.join(used)}")


def add_ports(kind: str, component: str, words: Sequence[str], dry_run: bool, as_json: bool, **more: Any) -> None:
    """Adds ports `NAME:TYPE` to a component."""
    with explaining():
        project, source = open_source(component)
        from fwk.scaffold.ports import PortRequest, add_port

        for word in words:
            name, colon, types = word.partition(":")
            if not colon or not types:
                raise ScaffoldError(f"'{word}' is not a port; write NAME:TYPE, such as ball:garden.ball_t")
            full = check_port_types(project, kind, [each.strip() for each in types.split(",")])
            add_port(source, PortRequest(kind, name, full, **more))
        finish(source, dry_run, as_json)


def remove_each(
    component: str, names: Sequence[str], dry_run: bool, as_json: bool, remove: "Callable[[Source, str], list[str]]"
) -> None:
    """Removes parts of a component by their names."""
    with explaining():
        _, source = open_source(component)
        used = [place for name in names for place in remove(source, name)]
        finish(source, dry_run, as_json, used)
