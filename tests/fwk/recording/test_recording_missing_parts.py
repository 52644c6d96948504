"""Logs of several files, of which some are missing between others."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.event_log import LogReader
from fwk.lcm.log_parts import parts_of
from fwk.recording.indexed_log import IndexedLogWriter
from fwk.recording.log_info import log_info
from fwk.recording.missing_parts import MissingParts, missing_parts
from fwk.recording.part_compressor import compress_part
from tests.fwk.log_tools.log_tools_made import recording


def split_recording(folder: Path, missing: tuple[int, ...] = (1,)) -> Path:
    """Writes a recording of 12 ticks in four parts of three ticks, without some of the parts."""
    whole, log = recording(folder / "whole.lcm", ticks=12, noted=2), folder / "log.lcm"
    with IndexedLogWriter(log, pytest.fail) as made:
        records = 0
        for event in LogReader(whole):
            made.append(event.channel, event.data, event.time_us)
            records += event.channel == "fwk/record"
            if event.channel == "fwk/record" and records in (3, 6, 9):
                made.split()
    for part in missing:
        (folder / f"log.lcm.{part:02}").unlink()
    return log


def test_reading_continues_behind_a_missing_part(tmp_path: Path) -> None:
    log = split_recording(tmp_path)
    records = [event.time_us for event in LogReader(log) if event.channel == "fwk/record"]
    assert [time_us // 50_000 for time_us in records] == [1, 2, 3, 7, 8, 9, 10, 11, 12]
    assert missing_parts(log) == [MissingParts([f"{log}.01"], 15, 3, 7)]
    assert str(missing_parts(log)[0]) == f"{log}.01 is missing: 15 events between tick 3 and tick 7"
    info = log_info(log)
    assert (info.dropped, info.missing, info.changed) == (0, missing_parts(log), [])


def test_several_missing_parts_are_named_together(tmp_path: Path) -> None:
    log = split_recording(tmp_path, missing=(1, 2))
    assert compress_part(log)
    (missing,) = missing_parts(tmp_path / "log.lcm.zst")
    assert str(missing) == f"{log}.01 to {log}.02 are missing: 30 events between tick 3 and tick 10"


def test_an_empty_part_counts_as_a_missing_one(tmp_path: Path) -> None:
    log = split_recording(tmp_path, missing=())
    (tmp_path / "log.lcm.02").write_bytes(b"")
    assert [each.files for each in missing_parts(log)] == [[f"{log}.02"]]


def test_a_part_with_a_damaged_beginning_is_read(tmp_path: Path) -> None:
    log = split_recording(tmp_path, missing=())
    data = (tmp_path / "log.lcm.02").read_bytes()
    (tmp_path / "log.lcm.02").write_bytes(bytes(9) + data[9:])
    assert (missing_parts(log), len(parts_of(log))) == ([], 4)
    info = log_info(log)
    assert (info.damaged_bytes > 0, info.ticks) == (True, (1, 12))


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["log-info", "LOG"], 1),
        (["compare", "LOG", "LOG"], 0),
        (["cut", "LOG", "--from", "2", "-o", "OUT"], 1),
        (["filter", "LOG", "--channels", "cyan1/*", "-o", "OUT"], 1),
        (["merge", "LOG", "LOG", "-o", "OUT"], 1),
        (["repair", "LOG", "-o", "OUT"], 1),
        (["export", "LOG", "--to", "jsonl", "-o", "OUT"], 1),
        (["plot", "cyan1/odometry.x_m", "--from", "LOG"], 1),
        (["compress", "LOG"], 1),
        (["replay", "LOG"], 2),
    ],
    ids=lambda each: each[0] if isinstance(each, list) else "",
)
def test_commands_name_missing_parts(tmp_path: Path, words: list[str], code: int) -> None:
    log = split_recording(tmp_path)
    paths = {"LOG": str(log), "OUT": str(tmp_path / "out")}
    result = CliRunner().invoke(app, [paths.get(word, word) for word in words])
    assert f"{log}.01 is missing: 15 events between tick 3 and tick 7" in result.stderr
    assert result.exit_code == code, result.output
    whole = CliRunner().invoke(app, ["log-info", str(tmp_path / "whole.lcm")])
    assert (whole.exit_code, whole.stderr) == (0, "")


def test_missing_parts_are_in_the_answer_for_programs(tmp_path: Path) -> None:
    log = split_recording(tmp_path)
    result = CliRunner().invoke(app, ["log-info", str(log), "--json"])
    assert json.loads(result.stdout)["missing"] == [
        {"files": [f"{log}.01"], "events": 15, "after_tick": 3, "before_tick": 7}
    ]
