"""A file that is no log, or that ends within its first event, is called so by every command that reads logs."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.cli.complete.candidates import complete
from fwk.lcm.event_log import SYNC

COMMANDS = [
    ["compare", "log", "log"],
    ["cut", "log", "--from", "1", "-o", "out"],
    ["export", "log", "-o", "out.csv"],
    ["filter", "log", "--channels", "*", "-o", "out"],
    ["log-info", "log"],
    ["monitor", "script.py", "--from", "log"],
    ["play", "log"],
    ["plot", "r/pose.x_m", "--from", "log", "-o", "out.png"],
    ["replay", "log"],
    ["video", "log", "-o", "out.mp4"],
    ["view", "--from", "log", "--save", "out.rrd"],
]


SCRIPT = """
channels = ("*",)


def message(channel, message, time_us):
    print(channel)
"""


def test_log_of_an_unknown_run_says_where_runs_are_listed() -> None:
    result = CliRunner().invoke(app, ["log", "nobody"])
    text = " ".join(result.output.replace("│", " ").split())
    assert (result.exit_code, "nobody: no such folder, and no run of this name; see 'fwk runs list'" in text) == (
        2,
        True,
    )


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    (tmp_path / "script.py").write_text(SCRIPT)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("content", [b"not a log", SYNC + bytes(5)], ids=["garbage", "cut off"])
@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_a_file_that_is_no_log_is_called_so(folder: Path, words: list[str], content: bytes) -> None:
    (folder / "log").write_bytes(content)
    reason = "cut off within its first event" if content.startswith(SYNC) else "not an LCM log: no event in it"
    done = CliRunner().invoke(app, words)
    assert (done.exit_code, done.stdout) == (2, "")
    assert done.stderr == f"error: log: {reason}; it has {len(content)} bytes\n"
    assert {path.name for path in folder.iterdir()} == {"log", "script.py"}


def test_a_file_that_is_no_log_completes_to_nothing(folder: Path) -> None:
    (folder / "log").write_text("not a log")
    assert complete(["plot", "--from", "log", ""]) == []
