"""`fwk` finds its commands in modules."""

import subprocess
import sys

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import MODULES, app


@pytest.mark.parametrize("name", MODULES)
def test_every_command_explains_itself(name: str) -> None:
    result = CliRunner().invoke(app, [name, "--help"])
    assert result.exit_code == 0
    assert f"{name} " in result.output
    assert name in CliRunner().invoke(app, ["--help"]).output


def test_an_unknown_command_is_refused_with_the_nearest() -> None:
    result = CliRunner().invoke(app, ["compar"])
    assert result.exit_code == 2
    assert "Did you mean 'compare'?" in result.output


def test_a_command_is_imported_only_when_it_is_needed() -> None:
    asked = "import sys, fwk.cli.commands; print('fwk.cli.recordings.compare' in sys.modules)"
    assert subprocess.check_output([sys.executable, "-c", asked], text=True).strip() == "False"


def test_choosing_commands_accept_several_names() -> None:
    result = CliRunner().invoke(app, ["check", "--only", "world/simulator", "world/referee", "one-robot.yaml"])
    assert result.exit_code == 0, result.output
    assert result.output.startswith("one-robot: 2 components")
