"""Several logs in one, in the order of time."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogError, LogReader
from fwk.log_tools.merge import merge
from tests.fwk.log_tools.log_tools_made import PLAIN, channels_of, heard, recording
from tests.fwk.recording.recording_made import write


def test_events_are_in_the_order_of_time(tmp_path: Path) -> None:
    a = write(tmp_path / "a", [("a", b"1", 10), ("a", b"2", 30), ("a", b"3", 20), ("a", b"4", 40)])
    b = write(tmp_path / "b", [("b", b"1", 10), ("b", b"2", 35)])
    done = merge([a, b], tmp_path / "out")
    found = [(event.number, event.channel, event.data) for event in LogReader(done.out)]
    right = [("a", b"1"), ("b", b"1"), ("a", b"2"), ("a", b"3"), ("b", b"2"), ("a", b"4")]
    assert found == [(number, *each) for number, each in enumerate(right)], "each log keeps its own order"
    assert done.shared_channels == []


def test_a_recording_and_a_heard_log_need_one_clock(tmp_path: Path) -> None:
    logs = [recording(tmp_path / "log", ticks=2), heard(tmp_path / "heard", ticks=2)]
    with pytest.raises(LogError, match=r"heard: begins 19676 days after .*log: their clocks differ.*--align"):
        merge(logs, tmp_path / "out")
    done = merge(logs, tmp_path / "out", align=True)
    assert channels_of(done.out)[:4] == ["fwk/plan", "fwk/excerpt", "cyan2/odometry", "cyan1/odometry"]
    assert [event.time_us for event in LogReader(done.out) if event.channel == "cyan2/odometry"] == [0, 50_000]


def test_stamps_of_two_logs_are_not_mixed_up(tmp_path: Path) -> None:
    logs = [recording(tmp_path / name, ticks=2) for name in ("a", "b")]
    result = CliRunner().invoke(app, ["merge", *map(str, logs), "-o", str(tmp_path / "out"), "--json"])
    told = json.loads(result.stdout)
    assert told["shared_channels"] == [PLAIN, "cyan1/odometry", "cyan1/world_model"]
    names = channels_of(tmp_path / "out")
    assert (names.count("fwk/plan"), names.count(STAMP)) == (1, 4)
    assert all(names[place + 1] == PLAIN for place, name in enumerate(names) if name == STAMP)


def test_an_empty_log_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="empty: nothing to merge: no event in it"):
        merge([recording(tmp_path / "log"), write(tmp_path / "empty", [])], tmp_path / "out")
