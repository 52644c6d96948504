"""Progress bar of commands that read whole logs."""

import io
import sys
from pathlib import Path

import pytest

from fwk.cli.recordings import progress
from fwk.cli.recordings.progress import progress_of


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def shown(monkeypatch: pytest.MonkeyPatch, stream: io.StringIO, log: Path) -> str:
    """Returns what a command prints that has read half of a log."""
    monkeypatch.setattr(sys, "stderr", stream)
    monkeypatch.setenv("TERM", "xterm")
    with progress_of("reading", log) as report:
        report(log.stat().st_size // 2)
    return stream.getvalue()


def test_a_bar_is_shown_on_a_terminal_for_large_logs(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    log = tmp_path / "big.lcm"
    log.write_bytes(bytes(1000))
    assert shown(monkeypatch, Terminal(), log) == ""
    monkeypatch.setattr(progress, "_SMALL_BYTES", 1000)
    assert "reading big.lcm" in shown(monkeypatch, Terminal(), log)
    assert shown(monkeypatch, io.StringIO(), log) == ""
