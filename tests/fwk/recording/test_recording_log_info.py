"""Information that `log_info` gives about a log."""

import json
from pathlib import Path
from typing import Any

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.recordings.log_info import log_info as command
from fwk.lcm.event_log import LogError, LogReader, LogWriter
from fwk.lcm.messages import type_named
from fwk.lcm.type_registry import use_types_of
from fwk.recording.log_contents import ChannelInfo
from fwk.recording.log_info import log_info
from tests.fwk.recording.recording_made import entries, entry, odometry, write


def test_counts_rates_and_ticks_of_a_whole_log(tmp_path: Path) -> None:
    info = log_info(write(tmp_path / "log", entries(ticks=21)))
    assert list(info.channels) == [
        "cyan1/odometry",
        "cyan1/world_model",
        "cyan2/odometry",
        "cyan2/world_model",
        "fwk/log",
    ]
    assert (info.events, info.duration_s, info.ticks) == (105, 1.0, (1, 21))
    assert (info.dropped, info.damaged_bytes) == (0, 0)
    odometry_info = info.channels["cyan1/odometry"]
    assert odometry_info.types == ["robot.odometry_t"]
    assert odometry_info.writers == ["cyan1/base"]
    assert odometry_info.messages == 21
    assert odometry_info.rate_hz == pytest.approx(20.0)
    assert (odometry_info.first_tick, odometry_info.last_tick) == (1, 21)
    assert (odometry_info.lost, odometry_info.repeated, odometry_info.undecodable) == (0, 0, 0)
    assert odometry_info.bytes == sum(len(e.data) for e in LogReader(info.file) if e.channel == "cyan1/odometry")
    assert info.channels["fwk/log"].first_tick is None


def test_gaps_are_counted_and_named(tmp_path: Path) -> None:
    ticks = [t for t in range(3, 30) if t not in (7, 10, 11, 12)]
    made = log_info(write(tmp_path / "log", [entry("a/odometry", odometry(t, 1), t) for t in ticks])).channels[
        "a/odometry"
    ]
    assert (made.lost, made.gaps) == (4, [(7, 7), (10, 12)])


def test_of_many_gaps_the_first_few_are_named(tmp_path: Path) -> None:
    made = log_info(write(tmp_path / "log", [entry("a/odometry", odometry(t, 1), t) for t in range(1, 60, 2)]))
    assert made.channels["a/odometry"].lost == 29
    assert made.channels["a/odometry"].gaps == [(2 * n, 2 * n) for n in range(1, ChannelInfo.GAPS_SHOWN + 1)]


def test_repeated_messages_are_counted_and_hide_no_gap(tmp_path: Path) -> None:
    ticks = [1, 2, 3, 2, 3, 5]
    made = log_info(write(tmp_path / "log", [entry("a/odometry", odometry(t, 1), t) for t in ticks])).channels[
        "a/odometry"
    ]
    assert (made.messages, made.repeated, made.lost) == (6, 2, 1)


def test_messages_that_do_not_decode_are_counted(tmp_path: Path) -> None:
    channel, data, time_us = entry("a/odometry", odometry(1, 1), 1)
    log = write(
        tmp_path / "log",
        [(channel, data, time_us), (channel, data[:-9], 2), ("foreign", b"\1" * 20, 3), ("short", b"", 4)],
    )
    channels = log_info(log).channels
    assert channels["a/odometry"].undecodable == 1
    assert channels["foreign"].undecodable == 1
    assert channels["foreign"].types == ["unknown 0101010101010101"]
    assert channels["short"].undecodable == 1


def test_types_that_lcm_cannot_tell_apart_are_both_named(tmp_path: Path) -> None:
    (tmp_path / "lcmtypes").mkdir()
    structs = "".join(f"struct {name}_t {{ double apart_m; }}\n" for name in ("one", "other"))
    (tmp_path / "lcmtypes" / "twins.lcm").write_text(f"package twins;\n{structs}")
    use_types_of(tmp_path)
    twin: Any = type_named("twins.one_t")()
    log = write(tmp_path / "log", [("a/twin", twin.encode(), 1)])
    assert log_info(log).channels["a/twin"].types == ["twins.one_t or twins.other_t"]


def test_dropped_events_and_damage_are_reported(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", print) as writer:
        writer.append("a", b"1", 1)
        writer.events += 3
        writer.append("a", b"2", 2)
    assert log_info(tmp_path / "log").dropped == 3
    (tmp_path / "log").write_bytes((tmp_path / "log").read_bytes()[:-1])
    assert log_info(tmp_path / "log").damaged_bytes == 29


def test_a_file_that_is_not_a_log_is_refused(tmp_path: Path) -> None:
    (tmp_path / "text").write_text("hello")
    with pytest.raises(LogError, match="text: not an LCM log: no event in it; it has 5 bytes"):
        log_info(tmp_path / "text")


def test_the_command_shows_a_table_and_json(tmp_path: Path) -> None:
    app = typer.Typer()
    app.command()(command)
    log = write(tmp_path / "log", [entry("cyan1/odometry", odometry(t, 1), t) for t in (1, 2, 4, 5)])
    shown = CliRunner().invoke(app, [str(log)])
    assert shown.exit_code == 0
    assert (
        f"{log}: {log.stat().st_size} bytes, 4 events on 1 channels\nduration 0.200 s, ticks 1 to 5\n" in shown.stdout
    )
    row = next(line for line in shown.stdout.splitlines() if line.startswith("cyan1/odometry"))
    assert row.split() == ["cyan1/odometry", "robot.odometry_t", "4", "15.0", str(4 * 185), "1-5", "1", "(3)"]
    told = json.loads(CliRunner().invoke(app, ["--json", str(log)]).stdout)
    assert told["ticks"] == [1, 5]
    assert told["channels"]["cyan1/odometry"]["lost"] == 1
    assert told["channels"]["cyan1/odometry"]["rate_hz"] == pytest.approx(15.0)
    refused = CliRunner().invoke(app, [str(tmp_path / "none")])
    assert (refused.exit_code, refused.stderr) == (
        2,
        f"error: {tmp_path}/none: cannot read: No such file or directory\n",
    )
