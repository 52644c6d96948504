"""`fwk config get` of a launch file."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk import Clock, Component, Config
from fwk.cli.commands import app


class TurnerConfig(Config):
    gain: float = 0.3
    table: dict[str, int] = {}


class Turner(Component):
    stage = "think"
    config: TurnerConfig
    clock: Clock


@pytest.mark.parametrize(
    ("path", "printed"),
    [
        ("a/turner.gain", "0.5\n"),
        ("*/turner.gain", "a/turner.gain = 0.5\n"),
        ("a/turner.table", "a/turner.table.x = 3\n"),
        ("a/turner.table.x", "3\n"),
    ],
)
def test_bare_value_is_that_of_the_setting_asked_for(tmp_path: Path, path: str, printed: str) -> None:
    file = tmp_path / "it.yaml"
    use = f"{Turner.__module__}:Turner"
    file.write_text(f"components: {{a/turner: {{use: '{use}', config: {{gain: 0.5, table: {{x: 3}}}}}}}}\n")
    result = CliRunner().invoke(app, ["config", "get", path, "--file", str(file)])
    assert (result.exit_code, result.stdout) == (0, printed)
