"""Index of a log: the same contents without reading the log, and check sums that name damage."""

import json
import os
from dataclasses import replace
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.recordings.log_info import log_info as command
from fwk.lcm import messages
from fwk.lcm.envelope import STAMP
from fwk.model.names import NOTE
from fwk.recording.indexed_log import IndexedLogWriter
from fwk.recording.log_contents import LogInfo, Note
from fwk.recording.log_index import BLOCK_BYTES, LogIndex, index_path
from fwk.recording.log_info import log_info
from lcmtypes.core import histogram_t, log_t, stamp_t, tick_record_t
from tests.fwk.recording.recording_made import PERIOD_US, Entry, entries, entry, odometry


def note(tick: int, text: str, file: str = NOTE) -> Entry:
    line = log_t()
    line.tick, line.time_us, line.text, line.file = tick, tick * PERIOD_US, text, file
    return "fwk/log", line.encode(), line.time_us


def plain(sequence: int, tick: int) -> list[Entry]:
    """A message of a type without the header, after its stamp."""
    stamp = stamp_t()
    stamp.channel = "arm/times"
    stamp.header.tick, stamp.header.sequence, stamp.header.writer = tick, sequence, "arm/driver"
    time_us = tick * PERIOD_US
    return [(STAMP, stamp.encode(), time_us), (stamp.channel, messages.encode(histogram_t(), "arm/times"), time_us)]


def record(tick: int) -> Entry:
    made = tick_record_t()
    made.tick = tick
    return "fwk/record", made.encode(), tick * PERIOD_US


def indexed(path: Path, made: list[Entry]) -> Path:
    with IndexedLogWriter(path, pytest.fail) as writer:
        for channel, data, time_us in made:
            writer.append(channel, data, time_us)
    return path


def test_the_index_has_what_reading_the_log_finds(tmp_path: Path) -> None:
    made = [*entries(ticks=21), note(7, "ball taken away"), note(8, "a line", file="small.py")]
    log = indexed(tmp_path / "log", [*made, *plain(1, 3), *plain(2, 9), record(21)])
    told, read = log_info(log), log_info(log, check=True)
    assert (told.from_index, read.from_index) == (True, False)
    assert read.notes == [Note(7, 7 * PERIOD_US, "ball taken away")]
    assert replace(told, from_index=False) == read


def test_lost_and_repeated_messages_are_counted(tmp_path: Path) -> None:
    def made(channel: str, ticks: tuple[int, ...]) -> list[Entry]:
        return [entry(channel, odometry(tick, 1), tick) for tick in ticks]

    log = indexed(tmp_path / "log", [*made("a/odometry", (3, 4, 7)), *made("b/odometry", (1, 1, 2))])
    info = log_info(log)
    counts = {name: (each.lost, each.repeated, each.gaps) for name, each in info.channels.items()}
    assert counts == {"a/odometry": (2, 0, []), "b/odometry": (0, 1, [])}


def test_a_log_that_changed_is_read_again(tmp_path: Path) -> None:
    log = indexed(tmp_path / "log", entries(ticks=3))
    log.write_bytes(log.read_bytes()[:-1])
    info = log_info(log)
    assert (info.from_index, info.damaged_bytes > 0) == (False, True)
    assert [str(part) for part in info.changed] == [
        f"bytes {log.stat().st_size} to {log.stat().st_size} (ticks 1 to 1) are missing"
    ]


def test_a_copied_log_keeps_its_index(tmp_path: Path) -> None:
    log = indexed(tmp_path / "log", entries(ticks=3))
    os.utime(log, (1, 1))
    assert log_info(log).from_index


def test_check_sums_name_the_damaged_block(tmp_path: Path) -> None:
    big = [("big", bytes(1000), 1) for _ in range(BLOCK_BYTES // 1000)]
    log = indexed(tmp_path / "log", [*big, record(1), *big, record(2), *big, record(3)])
    index = LogIndex.of(log)
    assert index
    first, second, *_ = index.blocks
    with open(log, "r+b") as file:
        file.seek(second.end - 500)
        file.write(b"\1")
    (part,) = log_info(log, check=True).changed
    assert (part.first, part.last, part.missing) == (first.end, second.end - 1, False)
    assert (part.first_tick, part.last_tick) == (first.tick + 1, second.tick + 1)
    os.utime(log, ns=(index.mtime_ns, index.mtime_ns))
    app = typer.Typer()
    app.command()(command)
    assert CliRunner().invoke(app, [str(log)]).exit_code == 0, "the index tells what was written"
    checked = CliRunner().invoke(app, [str(log), "--check"])
    assert (checked.exit_code, f"damaged: {part}" in checked.stdout) == (1, True)
    told = json.loads(CliRunner().invoke(app, [str(log), "--check", "--json"]).stdout)
    assert told["changed"] == [part._asdict()]


@pytest.mark.parametrize("text", ["", "{}", "[1]", '{"version": 99}', '{"version": 1, "blocks": [[1]]}'])
def test_an_index_that_cannot_be_read_is_ignored(tmp_path: Path, text: str) -> None:
    log = indexed(tmp_path / "log", entries(ticks=3))
    index_path(log).write_text(text)
    info: LogInfo = log_info(log)
    assert (info.from_index, info.events) == (False, 15)


def test_a_log_that_lacks_events_has_no_index(tmp_path: Path) -> None:
    indexed(tmp_path / "log", entries(ticks=3))
    with IndexedLogWriter(tmp_path / "log", print) as writer:
        assert not index_path(writer.path).exists(), "the old index went with the old log"
        writer.append("a", b"1", 1)
        writer.dropped += 1
    assert not index_path(tmp_path / "log").exists()


def test_a_device_has_no_index() -> None:
    indexed(Path("/dev/null"), entries(ticks=1))
    assert not index_path(Path("/dev/null")).exists()
