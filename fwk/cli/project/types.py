"""`fwk types`: generates message types for Python, C, C++ and Java."""

import json
from pathlib import Path
from typing import Annotated

import typer

from fwk.cli.output import say
from fwk.cli.project.changing import explaining
from fwk.cli.run_options import Json
from fwk.plan.files.launch_file import shown
from fwk.scaffold.bindings import LANGUAGES, compile_line, generate_bindings
from fwk.scaffold.changes import ScaffoldError
from fwk.scaffold.interface import generate_types
from fwk.scaffold.project import project_at


def types(
    folder: Annotated[Path | None, typer.Argument(metavar="DIR", help="folder for the types of C, C++ or Java")] = None,
    lang: Annotated[str, typer.Option(metavar="LANGUAGE", help=f"python, {', '.join(LANGUAGES)}")] = "python",
    packages: Annotated[
        list[str] | None, typer.Option("--package", metavar="NAME", help="also these installed types; repeatable")
    ] = None,
    as_json: Json = False,
) -> None:
    """Generates the message types of the project and all types that they contain, for C and C++ with fwk.h.

    Python's classes are generated beside the .lcm files; fwk-launch and fwk check do that by themselves.
    """
    with explaining():
        project = project_at(Path.cwd())
        if lang == "python":
            made = generate_types(project)
        elif folder is None:
            raise ScaffoldError(f"name a folder for the types: fwk types --lang {lang} native/types")
        else:
            made = generate_bindings(project, lang, folder, packages or ())
        if as_json:
            say(json.dumps({"files": [str(each) for each in made]}, indent=2))
            return
        say(*(f"made: {shown(each)}" for each in made[:5]))
        if len(made) > 5:
            say(f"and {len(made) - 5} more")
        if folder is not None and lang != "python":
            say(f"next: {compile_line(lang, folder)}")
