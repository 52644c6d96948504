"""A project with a component of every kind passes its own lint, types and tests, runs and replays."""

import subprocess
from pathlib import Path

import pexpect
import pytest

from fwk.scaffold.changes import write
from fwk.scaffold.interface import generate_types
from fwk.scaffold.new import new_component, new_project
from fwk.scaffold.project import NAME_MAX, Project
from fwk.scaffold.templates import kinds
from tests.fwk.cli.cli_processes import environment, run
from tests.harness.commands import BIN
from tests.harness.runs import Launched, PortBlock, replayed

pytestmark = [pytest.mark.system]


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Project:
    """A project with two components of every kind; the tests of this file need a compiler for those in C."""
    made = Project(tmp_path_factory.mktemp("project"))
    write(new_project("garden", made.root))
    for kind in kinds():
        write(new_component(made, f"{kind}{'x' * NAME_MAX}"[:NAME_MAX], kind))
        write(new_component(made, f"{kind[:2]}x", kind))
    generate_types(made)
    done = run(made.root, "make", "--silent", "-C", "native")
    assert done.returncode == 0, done.stdout
    return made


@pytest.mark.parametrize("tool", ["ruff format --check .", "ruff check .", "mypy", "pytest -q -p no:cacheprovider"])
def test_every_kind_passes_the_projects_own_checks(project: Project, tool: str) -> None:
    program, *words = tool.split()
    done = subprocess.run(
        [BIN / program, *words],
        cwd=project.root,
        env=environment(project.root),
        capture_output=True,
        text=True,
        timeout=250,
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_every_kind_runs_and_replays(project: Project, ports: PortBlock) -> None:
    assert run(project.root, "fwk", "check", "garden.yaml").returncode == 0
    arguments = ("garden.yaml", "--ticks", "20", "--speed", "max", "--record", "log.lcm", "--hosting", "single")
    launched = Launched(project.root, ports, (*arguments, "--set", f"public_url={ports.public_url}"), {})
    try:
        assert launched.wait() == 0, launched.text
        assert "failed" not in launched.text
    finally:
        launched.end()
    replayed(project.root)


def test_missing_words_are_asked_for_on_a_terminal(tmp_path: Path) -> None:
    child = pexpect.spawn(str(BIN / "fwk"), ["new", "project"], cwd=tmp_path, timeout=60, encoding="utf-8")
    child.expect("Name of the project: ")
    child.sendline("orchard")
    child.expect("next: cd orchard && fwk-launch orchard.yaml")
    child.expect(pexpect.EOF)
    child.close()
    assert (child.exitstatus, (tmp_path / "orchard/launch/orchard.yaml").exists()) == (0, True)
