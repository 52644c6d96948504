"""`fwk new project|component|interface|launch`: makes files of a project."""

import os
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.output import say
from fwk.cli.project.changing import DryRun, Force, asked, carry_out, explaining
from fwk.cli.run_options import Json
from fwk.plan.files.launch_file import shown
from fwk.scaffold.interface import KINDS, generate_types, new_interface
from fwk.scaffold.new import new_component, new_launch, new_project
from fwk.scaffold.programs import build_programs
from fwk.scaffold.project import Project, project_at
from fwk.scaffold.templates import kinds

new = typer.Typer(add_completion=False, no_args_is_help=True)

_KINDS, _TYPES = ", ".join(kinds()), ", ".join(KINDS)


@new.callback()
def group() -> None:
    """Makes a project, a component, a message type or a launch file."""


@new.command("project")
def project(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="name of the project and its launch file")] = None,
    folder: Annotated[
        Path | None, typer.Option(metavar="FOLDER", help="folder of the project; default: NAME, made here")
    ] = None,
    dry_run: DryRun = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Makes a project that runs at once: two components, a message type, a launch file, tests and a README.

    On a terminal, the command asks for a missing NAME.
    """
    with explaining():
        chosen = asked(name, "Name of the project", "NAME")
        root = folder or Path(chosen)
        changes = new_project(chosen, root)
        carry_out(changes, dry_run, force, as_json, (f"cd {shown(root)}", f"fwk-launch {chosen}.yaml"))
        if not dry_run:
            generate_types(Project(root))


@new.command("component")
def component(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="name, such as ball_tracker")] = None,
    kind: Annotated[str | None, typer.Option(metavar="KIND", help=f"one of {_KINDS}; default: stages")] = None,
    launch: Annotated[
        str | None, typer.Option(metavar="FILE", help="launch file that gets the component; default: the only one")
    ] = None,
    namespace: Annotated[
        str | None, typer.Option(metavar="WORD", help="its namespace there; default: the first one in the file")
    ] = None,
    dry_run: DryRun = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Makes a component with its settings, message types and test, and adds it to launch file and README.

    The component runs as it is and is meant to be changed. On a terminal, the command asks for a missing NAME and KIND.
    """
    with explaining():
        found = project_at(Path.cwd())
        chosen = asked(name, "Name of the component", "NAME")
        sort = asked(kind, f"Kind: {_KINDS}", "--kind", "stages")
        changes = new_component(found, chosen, sort, launch, namespace)
        file = found.launch_file(launch).name
        carry_out(changes, dry_run, force, as_json, (f"fwk check {file}", f"fwk-launch {file}"))
        if dry_run:
            return
        generate_types(found)
        if sort == "c":
            built = build_programs(found)
            typer.echo(built, err=True) if as_json else say(built)


@new.command("interface")
def interface(
    name: Annotated[
        str | None, typer.Argument(metavar="PACKAGE.NAME", help="name of the type, such as garden.moisture")
    ] = None,
    fields: Annotated[
        list[str] | None, typer.Argument(metavar="FIELD:TYPE...", help="its members, such as x_m:double")
    ] = None,
    kind: Annotated[str, typer.Option(metavar="KIND", help=f"one of {_TYPES}")] = "message",
    dry_run: DryRun = False,
    as_json: Json = False,
) -> None:
    """Adds a message type to lcmtypes/PACKAGE.lcm and generates its Python class.

    Types of members are boolean, byte, int8_t, int16_t, int32_t, int64_t, float, double, string, types of the project
    or of other packages (core.header_t), and arrays: `ranges_m:float[8]`, or `n:int32_t xs:double[n]`.
    """
    with explaining():
        found = project_at(Path.cwd())
        chosen = asked(name, "Name of the type, as PACKAGE.NAME", "PACKAGE.NAME")
        members = fields or asked("" if name else None, "Fields, as NAME:TYPE", "FIELD:TYPE", "").split()
        change = new_interface(found, chosen, members, kind)
        carry_out([change], dry_run, False, as_json)
        if not dry_run:
            generate_types(found)
            if not as_json:
                short = chosen.removesuffix("_t").rpartition(".")[2]
                say(f"next: from lcmtypes.{change.path.stem} import {short}_t")


@new.command("launch")
def launch(
    name: Annotated[str | None, typer.Argument(metavar="NAME", help="name of the launch file")] = None,
    modules: Annotated[
        list[str] | None,
        typer.Argument(metavar="MODULE...", help="modules of the components; default: all of the project"),
    ] = None,
    namespace: Annotated[str, typer.Option(metavar="WORD", help="namespace of the components")] = "robot",
    dry_run: DryRun = False,
    force: Force = False,
    as_json: Json = False,
) -> None:
    """Makes a launch file with components of the project."""
    with explaining():
        found = project_at(Path.cwd())
        chosen = asked(name, "Name of the launch file", "NAME")
        changes = new_launch(found, chosen, modules or (), namespace)
        carry_out(changes, dry_run, force, as_json, (f"fwk check {os.path.basename(changes[0].path)}",))
