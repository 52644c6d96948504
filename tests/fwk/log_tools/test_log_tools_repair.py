"""A damaged log made whole: every whole event stays, and losses are named."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.event_log import LogError, LogReader
from fwk.log_tools.repair import repair
from fwk.recording.log_info import log_info
from tests.fwk.log_tools.log_tools_made import recording


def test_a_torn_end_costs_one_event(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    whole = log.read_bytes()
    events = list(LogReader(log))
    log.write_bytes(whole[:-5])
    done = repair(log, tmp_path / "out")
    kept = len(whole) - 28 - len("fwk/record") - len(events[-1].data)
    assert done.out.read_bytes() == whole[:kept]
    assert done.lost_bytes == [(kept, len(whole) - 6)]
    assert (done.events, done.lost_events, done.last_tick, done.unfinished_events) == (len(events) - 1, 0, 9, 4)
    assert log_info(done.out).from_index


def test_damage_in_the_middle_leaves_a_gap_in_the_numbers(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    whole = log.read_bytes()
    second = whole.index(b"\xed\xa1\xda\x01", 4)
    log.write_bytes(whole[: second + 6] + whole[second + 9 :])
    result = CliRunner().invoke(app, ["repair", str(log), "-o", str(tmp_path / "out"), "--json"])
    told = json.loads(result.stdout)
    assert (told["lost_events"], len(told["lost_bytes"]), told["last_tick"]) == (1, 1, 10)
    assert [event.number for event in LogReader(tmp_path / "out")][:3] == [0, 2, 3]
    said = CliRunner().invoke(app, ["repair", str(log), "-o", str(tmp_path / "out"), "--force"]).stdout.splitlines()
    first, last = told["lost_bytes"][0]
    assert said[1:] == [
        f"lost: bytes {first} to {last}, not a whole event",
        "lost: 1 events, according to the numbers of the others",
        "last whole tick: 10; 0 events after it",
    ]


def test_a_whole_log_gets_an_index(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    done = repair(log, tmp_path / "out")
    assert done.out.read_bytes() == log.read_bytes()
    assert (done.lost_bytes, log_info(done.out).from_index) == ([], True)


def test_a_file_that_is_not_a_log_leaves_no_file(tmp_path: Path) -> None:
    (tmp_path / "text").write_text("hello")
    with pytest.raises(LogError, match="no event would be in it"):
        repair(tmp_path / "text", tmp_path / "out")
    assert [path.name for path in tmp_path.iterdir()] == ["text"]


def test_bytes_that_are_not_what_was_written_are_named(tmp_path: Path) -> None:
    log = repair(recording(tmp_path / "log"), tmp_path / "indexed").out
    data = bytearray(log.read_bytes())
    data[data.index(b"cyan1/odometry", len(data) // 2) + 40] ^= 1
    log.write_bytes(data)
    said = CliRunner().invoke(app, ["repair", str(log), "-o", str(tmp_path / "out")]).stdout
    assert f"damaged: bytes 0 to {len(data) - 1} (ticks 1 to 11) are not the bytes that were written" in said
