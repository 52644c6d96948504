"""Message types for C, C++ and Java: those of the project and what they contain, and nothing else."""

import json
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.project.types import types
from fwk.scaffold.bindings import compile_line, generate_bindings
from fwk.scaffold.changes import ScaffoldError, write
from fwk.scaffold.new import new_project
from fwk.scaffold.project import Project


@pytest.fixture
def project(tmp_path: Path) -> Project:
    """A new project with one message type."""
    write(new_project("garden", tmp_path))
    return Project(tmp_path)


@pytest.mark.parametrize(
    ("language", "files"),
    [
        ("c", ["core_header_t.c", "core_header_t.h", "fwk.h", "garden_distance_t.c", "garden_distance_t.h"]),
        ("cpp", ["core/header_t.hpp", "fwk.h", "garden/distance_t.hpp"]),
        ("java", ["core/header_t.java", "garden/distance_t.java"]),
    ],
)
def test_types_and_what_they_contain_are_written(project: Project, language: str, files: list[str]) -> None:
    folder = project.root / "made" / language
    made = generate_bindings(project, language, folder)
    assert [str(each.relative_to(folder)) for each in made] == files
    assert str(folder) in compile_line(language, folder)
    more = generate_bindings(project, language, folder, ["core"])
    assert len(more) > 20


def test_header_is_valid_cpp_with_its_types(project: Project, needs: Callable[..., None]) -> None:
    needs("c++")
    folder = project.root / "types"
    generate_bindings(project, "c", folder)
    program = project.root / "program.cpp"
    program.write_text('#define FWK_IMPLEMENTATION\n#include "fwk.h"\nint main() { return fwk_close(fwk_open()); }\n')
    flags = ["-fsyntax-only", "-Wall", "-Wextra", "-Werror", f"-I{folder}"]
    done = subprocess.run(["c++", *flags, program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


def test_mistakes_are_explained(project: Project) -> None:
    with pytest.raises(ScaffoldError, match="no types for 'rust'; there are c, cpp, java"):
        generate_bindings(project, "rust", project.root)
    with pytest.raises(ScaffoldError, match=r"no package of message types 'croe'; did you mean 'core'\?"):
        generate_bindings(project, "c", project.root, ["croe"])


def test_command_writes_types_or_says_what_is_missing(project: Project, monkeypatch: pytest.MonkeyPatch) -> None:
    app = typer.Typer()
    app.command()(types)
    monkeypatch.chdir(project.root)
    assert "made: lcmtypes/garden" in CliRunner().invoke(app, []).output
    missing = CliRunner().invoke(app, ["--lang", "c"])
    assert (missing.exit_code, "name a folder for the types: fwk types --lang c" in missing.output) == (2, True)
    done = CliRunner().invoke(app, ["--lang", "c", "types", "--json"])
    assert len(json.loads(done.stdout)["files"]) == 5
    assert "next: c++ -O2 -Itypes" in CliRunner().invoke(app, ["--lang", "cpp", "types"]).output
