"""`fwk config get` of a launch file, and the settings that `fwk config set --save` keeps beside one."""

from pathlib import Path
from typing import Annotated

import pytest
import typer
from typer.testing import CliRunner

from fwk import Alike, Clock, Component, Config
from fwk.cli.commands import app
from fwk.cli.steer.setting_files import keep_beside


class TurnerConfig(Config):
    gain: float = 0.3
    table: dict[str, int] = {}
    width_m: Annotated[float, Alike] = 2.0


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


def test_a_setting_that_the_next_run_would_refuse_is_not_kept(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, kept = tmp_path / "it.yaml", tmp_path / "it.host.yaml"
    entry = f"{{use: '{Turner.__module__}:Turner'}}"
    file.write_text(f"components: {{a/turner: {entry}, b/turner: {entry}}}\n")
    with pytest.raises(typer.Exit) as ended:
        keep_beside(str(file), ["b/turner.width_m=3", "b/turner.gain=0.5"])
    assert (ended.value.exit_code, kept.exists()) == (2, False)
    assert capsys.readouterr().err == (
        "error: b/turner: 'width_m' is 3.0 in b/turner, but 2.0 in a/turner; all components have to agree: state it "
        "once, under 'shared:'\nthe next run would refuse it, so nothing was set; it can be set for this run alone, "
        "without keeping it\n"
    )
    keep_beside(str(file), ["*/turner.width_m=3", "b/turner.gain=0.5"])
    assert "width_m: 3" in kept.read_text()
