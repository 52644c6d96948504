"""Text and exit codes of `fwk compare`, as scripts see them."""

from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.recordings.compare import compare
from fwk.lcm.event_log import LogWriter
from fwk.recording.indexed_log import IndexedLogWriter


@pytest.fixture
def fwk() -> typer.Typer:
    app = typer.Typer()
    app.command()(compare)
    return app


def log(path: Path, *messages: bytes) -> str:
    with LogWriter(path, print) as writer:
        for message in messages:
            writer.append("cyan1/x", message, 1)
    return str(path)


def test_exit_codes_for_equal_different_and_unusable_logs(tmp_path: Path, fwk: typer.Typer) -> None:
    a, same = log(tmp_path / "a", b"abc", b"d"), log(tmp_path / "same", b"abc", b"d")
    other = log(tmp_path / "other", b"abc", b"D")
    run = CliRunner().invoke
    equal = run(fwk, [a, same])
    assert (equal.exit_code, equal.stdout) == (0, "equal: 2 messages on 1 channels\n")
    different = run(fwk, [a, other])
    assert different.exit_code == 1
    assert different.stdout.startswith("different: cyan1/x: message 2")
    unusable = run(fwk, [a, str(tmp_path / "none")])
    assert (unusable.exit_code, unusable.stdout) == (2, "")
    assert unusable.stderr == f"error: {tmp_path}/none: cannot read: No such file or directory\n"


def test_a_run_directory_is_accepted_for_its_log(tmp_path: Path, fwk: typer.Typer) -> None:
    for run in ("one", "two"):
        (tmp_path / run).mkdir()
        log(tmp_path / run / "any_name", b"abc")
        (tmp_path / run / "plan.json").write_text("{}")
    assert CliRunner().invoke(fwk, [str(tmp_path / "one"), str(tmp_path / "two")]).exit_code == 0
    log(tmp_path / "one" / "second", b"abc")
    several = CliRunner().invoke(fwk, [str(tmp_path / "one"), str(tmp_path / "two")])
    assert several.exit_code == 2
    assert "one: a run directory holds one LCM log, this one: any_name, second" in several.stderr


def test_damage_is_mentioned(tmp_path: Path, fwk: typer.Typer) -> None:
    a = log(tmp_path / "a", b"abc")
    Path(a).write_bytes(Path(a).read_bytes() + b"\xed\xa1")
    result = CliRunner().invoke(fwk, [a, a])
    assert result.exit_code == 0
    assert f"{a}: 2 damaged bytes skipped" in result.stderr


def test_damage_is_told_from_a_difference(tmp_path: Path, fwk: typer.Typer) -> None:
    logs = [tmp_path / "a", tmp_path / "b"]
    for each in logs:
        with IndexedLogWriter(each, pytest.fail) as writer:
            writer.append("cyan1/x", b"abc", 1)
    equal = CliRunner().invoke(fwk, list(map(str, logs)))
    assert (equal.exit_code, equal.stderr) == (0, "")
    logs[1].write_bytes(logs[1].read_bytes().replace(b"abc", b"abd"))
    different = CliRunner().invoke(fwk, list(map(str, logs)))
    assert different.exit_code == 1
    assert different.stderr.startswith(f"{logs[1]}: damaged: bytes 0 to {logs[1].stat().st_size - 1} ")
