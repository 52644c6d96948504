"""A project with a component of every kind passes its own lint, types and tests, runs and replays."""

import subprocess
from collections.abc import Callable
from pathlib import Path

import pexpect
import pytest
from typer.testing import CliRunner

from fwk.cli.project.new import new
from fwk.scaffold.changes import write
from fwk.scaffold.interface import generate_types
from fwk.scaffold.new import new_component, new_project
from fwk.scaffold.project import NAME_MAX, Project
from fwk.scaffold.templates import kinds
from tests.fwk.cli.cli_processes import environment
from tests.harness.commands import BIN
from tests.harness.runs import Launched, PortBlock, replayed, write_files

pytestmark = [pytest.mark.system]


TRACKER = {
    "lcmtypes/tracking.lcm": (
        "package tracking;\n"
        "struct point_t { double x_m; double y_m; }\n"
        "struct track_t { point_t newest; int32_t n; point_t points[n]; string label; const int8_t LOST = 1; }\n"
    ),
    "procs/tracker.py": (
        '"""A component."""\n\n'
        "from fwk import Component, Config, Field, Reads, Writes\n"
        "from lcmtypes.tracking import point_t, track_t\n\n\n"
        "class TrackerConfig(Config):\n    gain: float = Field(0.3, ge=0.0)\n\n\n"
        'class Tracker(Component):\n    stage = "think"\n    config: TrackerConfig\n    track: Reads[track_t]\n'
        "    point: Writes[point_t]\n\n    def loop(self) -> None:\n"
        "        self.point.value = point_t(x_m=self.config.gain * self.track.value.newest.x_m)\n"
        "        self.point.write()\n"
    ),
}
"""A user's own component with types of which one contains the other."""


def made(folder: Path, name_of: Callable[[str], str]) -> Project:
    """Returns a project with a component of every kind."""
    project = Project(folder)
    write(new_project("garden", folder))
    for kind in kinds():
        write(new_component(project, name_of(kind), kind))
    generate_types(project)
    return project


def check(project: Project, *command: str) -> None:
    done = subprocess.run(
        [BIN / command[0], *command[1:]],
        cwd=project.root,
        env=environment(project.root),
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=250,
    )
    assert done.returncode == 0, done.stdout


def test_code_is_formatted_for_short_and_long_names(tmp_path: Path) -> None:
    made(tmp_path, lambda kind: f"{kind}{'x' * NAME_MAX}"[:NAME_MAX])
    project = made(tmp_path, lambda kind: f"{kind[:2]}x")
    check(project, "ruff", "format", "--check", ".")
    check(project, "ruff", "check", ".")


def test_every_kind_passes_types_and_tests_runs_and_replays(
    tmp_path: Path, needs: Callable[..., None], ports: PortBlock
) -> None:
    needs("cc", "make")
    project = made(tmp_path, lambda kind: f"my_{kind}")
    check(project, "pytest", "-q", "-p", "no:cacheprovider")  # builds the program in C, too
    write_files(project.root, TRACKER)
    generate_types(project)
    check(project, "mypy")
    check(project, "fwk", "check", "garden.yaml")
    arguments = ("garden.yaml", "--ticks", "20", "--speed", "max", "--record", "log.lcm", "--hosting", "single")
    launched = Launched(project.root, ports, (*arguments, "--set", f"public_url={ports.public_url}"), {})
    try:
        assert launched.wait() == 0, launched.text
        assert "failed" not in launched.text
    finally:
        launched.end()
    replayed(project.root)


def test_a_component_in_c_runs_at_once(
    tmp_path: Path, needs: Callable[..., None], monkeypatch: pytest.MonkeyPatch
) -> None:
    needs("cc", "make")
    write(new_project("garden", tmp_path))
    monkeypatch.chdir(tmp_path)
    said = CliRunner().invoke(new, ["component", "counter", "--kind", "c"])
    assert said.output.endswith("built with: make -C native\n")
    check(Project(tmp_path), "fwk", "check", "garden.yaml")
    monkeypatch.setenv("PATH", str(tmp_path))
    said = CliRunner().invoke(new, ["component", "other", "--kind", "c"])
    assert "not built: make: No such file or directory; install make and a C compiler" in said.output
    assert said.exit_code == 0


def test_missing_words_are_asked_for_on_a_terminal(tmp_path: Path) -> None:
    child = pexpect.spawn(str(BIN / "fwk"), ["new", "project"], cwd=tmp_path, timeout=60, encoding="utf-8")
    child.expect("Name of the project: ")
    child.sendline("orchard")
    child.expect("next: cd orchard && fwk-launch orchard.yaml")
    child.expect(pexpect.EOF)
    child.close()
    assert (child.exitstatus, (tmp_path / "orchard/launch/orchard.yaml").exists()) == (0, True)
