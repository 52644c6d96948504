"""`fwk` finds its commands in modules."""

import shlex
import subprocess
import sys
from functools import cache
from typing import Any

import pytest
from typer.main import get_command
from typer.testing import CliRunner

from fwk.cli.commands import MODULES, app
from fwk.cli.examples import EXAMPLES
from fwk.cli.run import launch_command


@pytest.mark.parametrize("name", MODULES)
def test_every_command_explains_itself(name: str) -> None:
    result = CliRunner().invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert f"{name} " in result.output
    assert name in _help()


@cache
def _help() -> str:
    """Returns the help of `fwk`, which lists all commands."""
    return CliRunner().invoke(app, ["--help"]).output


@pytest.mark.parametrize(
    ("path", "example"), [(path, each) for path, examples in EXAMPLES.items() for each in examples]
)
def test_every_example_can_be_typed(path: str, example: str) -> None:
    command: Any = get_command(launch_command.app if path == "fwk-launch" else app)
    words = shlex.split(example.removeprefix('eval "$(').removesuffix(')"'))
    for word in path.split()[1:]:
        command = command.commands[word]
    assert words[: len(path.split())] == path.split()
    command.make_context(path, words[len(path.split()) :])  # reads the words and runs nothing


def test_help_ends_with_examples() -> None:
    text = CliRunner().invoke(app, ["bb", "show", "--help"]).output
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    assert lines[-3:] == ["Examples:", "fwk bb show cyan1/world_model", "fwk bb show cyan1/world_model --json"]


def test_an_unknown_command_is_refused_with_the_nearest() -> None:
    result = CliRunner().invoke(app, ["doctr"])
    assert result.exit_code == 2
    assert "Did you mean 'doctor'?" in result.output


def test_a_command_is_imported_only_when_it_is_needed() -> None:
    asked = "import sys, fwk.cli.commands; print('fwk.cli.recordings.compare' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", asked], text=True).strip() == "False"


def test_choosing_commands_accept_several_names() -> None:
    result = CliRunner().invoke(app, ["check", "--only", "world/simulator", "world/referee", "one-robot.yaml"])
    assert result.exit_code == 0, result.output
    assert result.output.startswith("one-robot: 2 components")


def test_help_names_extras_and_fills_its_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    shown = [line.strip() for line in CliRunner().invoke(app, ["compress", "--help"]).stdout.splitlines()]
    assert "Needs: pip install 'fwk[compress]'" in shown
    assert "makes it a plain LCM log again, as lcm-logplayer needs it. The file that a run" in shown
