"""Parts of logs: intervals, channels, types; the new log appears whole or not at all."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from lcm import EventLog
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogError, LogReader, LogWriter
from fwk.log_tools.cut import cut
from fwk.log_tools.selection import Selection
from fwk.recording.log_info import log_info
from fwk.recording.part_compressor import compress_part
from fwk.recording.play.timeline import Timeline
from fwk.recording.replay.recording import Recording, RecordingError
from fwk.recording.ticks import tick_of
from lcmtypes.core import excerpt_t
from tests.fwk.log_tools.log_tools_made import PLAIN, channels_of, heard, recording
from tests.fwk.recording.recording_made import write

ALL = Selection()


def ticks_in(log: Path) -> tuple[int, int] | None:
    return log_info(log, check=True).ticks


def excerpt_in(log: Path) -> str:
    found = [excerpt_t.decode(event.data).text for event in LogReader(log) if event.channel == "fwk/excerpt"]
    return ", ".join(found)


@pytest.mark.parametrize(
    ("begin", "end", "ticks"),
    [
        ("3", "5", (3, 5)),
        ("3", "", (3, 10)),
        ("0.15s", "0.25s", (3, 5)),
        ("ball taken", "ball taken away", (4, 4)),
        ("", "2", (1, 2)),
    ],
)
def test_an_interval_has_whole_ticks(tmp_path: Path, begin: str, end: str, ticks: tuple[int, int]) -> None:
    done = cut(recording(tmp_path / "log"), tmp_path / "out", ALL, begin, end)
    assert ticks_in(done.out) == ticks
    events = list(LogReader(done.out))
    assert (len(events), events[0].channel, events[-1].channel) == (done.events, "fwk/plan", "fwk/record")
    assert log_info(done.out).from_index


def test_the_beginning_of_a_recording_is_unchanged(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    done = cut(log, tmp_path / "out", ALL, end="5")
    assert done.replayable
    assert log.read_bytes().startswith(done.out.read_bytes())


def test_other_parts_say_so_and_are_not_replayed(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    done = cut(log, tmp_path / "out", Selection(["cyan1/*"]), "3", "5")
    assert not done.replayable
    assert excerpt_in(done.out) == "log, from 3, to 5, channels cyan1/*"
    for info in (log_info(done.out), log_info(done.out, check=True)):
        assert info.excerpt == "log, from 3, to 5, channels cyan1/*"
    with pytest.raises(RecordingError, match=r"a part of a recording \(log, from 3, to 5, channels cyan1/\*\)"):
        list(Recording(done.out).ticks())


def test_stamps_stay_with_their_messages(tmp_path: Path) -> None:
    log = recording(tmp_path / "log", ticks=2)
    only = cut(log, tmp_path / "only", Selection([PLAIN]))
    assert channels_of(only.out) == ["fwk/plan", "fwk/excerpt", *[STAMP, PLAIN] * 2]
    without = cut(log, tmp_path / "without", Selection(exclude=[PLAIN]))
    assert {STAMP, PLAIN}.isdisjoint(channels_of(without.out))


def test_without_the_frameworks_channels_a_plain_log_is_left(tmp_path: Path) -> None:
    done = cut(recording(tmp_path / "log", ticks=1), tmp_path / "out", Selection(exclude=["fwk/*"]))
    assert channels_of(done.out) == ["cyan1/odometry", "cyan1/world_model", PLAIN]


def test_messages_are_selected_by_type(tmp_path: Path) -> None:
    done = cut(recording(tmp_path / "log", ticks=1), tmp_path / "out", Selection(types=["soccer.*"]))
    assert channels_of(done.out) == ["fwk/plan", "fwk/excerpt", "cyan1/world_model", "fwk/record"]


def test_logs_of_lcm_logger_are_cut_by_seconds(tmp_path: Path) -> None:
    done = cut(heard(tmp_path / "log"), tmp_path / "out", ALL, "0.1s", "0.2s")
    assert ticks_in(done.out) == (2, 4)
    assert not done.replayable
    assert set(channels_of(done.out)) == {"cyan2/odometry"}, "no marker in a log without a plan"


def test_the_last_seconds_end_when_the_command_begins(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = recording(tmp_path / "log")
    before = next(event.time_us for event in LogReader(log) if tick_of(event.channel, event.data) == 8)
    monkeypatch.setattr(Timeline, "_last_time_us", lambda _: before)  # ticks 9 and 10 are written later
    assert ticks_in(cut(log, tmp_path / "out", ALL, last_s=0.1).out) == (6, 8)


def test_the_last_seconds_are_an_interval(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    done = cut(log, tmp_path / "out", ALL, last_s=0.2)
    assert (ticks_in(done.out), excerpt_in(done.out)) == ((6, 10), "log, the last 0.2 s")
    assert log_info(done.out).duration_s == pytest.approx(0.2)  # the plan stands at the beginning of the interval
    assert cut(log, tmp_path / "all", ALL, last_s=99).events == log_info(log).events
    both = ["cut", str(log), "-o", str(tmp_path / "both"), "--last", "1", "--to", "3"]
    assert "--last is an interval of its own" in CliRunner().invoke(app, both).stderr


def test_the_reader_of_lcm_reads_the_new_log(tmp_path: Path) -> None:
    done = cut(recording(tmp_path / "log"), tmp_path / "out", ALL, "3", "5")
    ours = [(event.channel, event.time_us, event.data) for event in LogReader(done.out)]
    assert [(each.channel, each.timestamp, each.data) for each in EventLog(str(done.out), "r")] == ours


def test_a_part_of_a_part_is_not_replayable_either(tmp_path: Path) -> None:
    part = cut(recording(tmp_path / "log"), tmp_path / "part", ALL, "3")
    assert not cut(part.out, tmp_path / "out", ALL, end="5").replayable


@pytest.mark.parametrize(
    ("selection", "begin", "end", "reason"),
    [
        (ALL, "99", "", "no tick 99; the last one is 10"),
        (ALL, "5", "3", "'3' is before '5'; exchange --from and --to"),
        (ALL, "corner", "", "no bookmark 'corner'"),
        (Selection(["cyn1/odometry"]), "", "", "no channel matches 'cyn1/odometry'; did you mean 'cyan1/odometry'"),
        (Selection(exclude=["*"]), "", "", "no event would be in it"),
        (Selection(types=["robot.imu_t"]), "", "", "no message of type robot.imu_t; types in it: robot.odometry_t, "),
    ],
)
def test_a_cut_without_result_writes_nothing(
    tmp_path: Path, selection: Selection, begin: str, end: str, reason: str
) -> None:
    log = recording(tmp_path / "log")
    with pytest.raises(LogError) as error:
        cut(log, tmp_path / "out", selection, begin, end)
    assert reason in str(error.value)
    assert [path.name for path in tmp_path.iterdir()] == ["log"]


def test_existing_files_are_replaced_only_by_force(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    (tmp_path / "out").write_text("mine")
    refused = CliRunner().invoke(app, ["cut", str(log), "-o", str(tmp_path / "out"), "--to", "3"])
    assert (refused.exit_code, (tmp_path / "out").read_text()) == (2, "mine")
    assert "out: exists already; choose another name, or replace it with --force" in refused.stderr
    forced = CliRunner().invoke(app, ["cut", str(log), "-o", str(log), "--to", "3", "--force"])
    assert (forced.exit_code, ticks_in(log)) == (0, (1, 3)), "a log may be replaced by its part"


def test_the_commands_tell_what_they_did(tmp_path: Path) -> None:
    log, out = str(recording(tmp_path / "log", ticks=2)), str(tmp_path / "out")
    run = CliRunner().invoke
    said = run(app, ["filter", log, "-o", out, "--channels", "cyan1/*", "--exclude", "*/world_model"])
    assert (said.exit_code, said.stdout) == (0, f"{out}: 4 events; 6 not selected\n")
    told = json.loads(run(app, ["cut", log, "-o", out, "--to", "1", "--force", "--json"]).stdout)
    assert told == {
        "log": log, "out": out, "events": 6, "left_out": 0, "damaged_bytes": 0, "replayable": True,
    }  # fmt: skip
    assert run(app, ["cut", log, "-o", out]).exit_code == run(app, ["filter", log, "-o", out]).exit_code == 2


def test_a_full_disk_ends_the_work_without_a_file(tmp_path: Path, small_disk: Callable[[int], Path]) -> None:
    log = write(tmp_path / "log", [("big", bytes(300_000), time_us) for time_us in range(8)])
    disk = small_disk(1)
    result = CliRunner().invoke(app, ["filter", str(log), "--channels", "*", "-o", str(disk / "out")])
    assert (result.exit_code, list(disk.iterdir())) == (2, [])
    assert result.stderr == f"error: {disk}/out: cannot be written: the disk is full, or failed\n"


def test_a_new_log_replaces_all_parts_of_the_old_one(tmp_path: Path) -> None:
    out = tmp_path / "out.lcm"
    with LogWriter(out, pytest.fail) as old:
        for number in range(4):
            old.append("old", b"%d" % number, number)
            if number < 3:
                old.split()
    compress_part(out)
    log = recording(tmp_path / "log.lcm")
    with pytest.raises(LogError, match="exists already"):
        cut(log, out, Selection())
    cut(log, out, Selection(), replace=True)
    assert channels_of(out) == channels_of(log)
    assert not list(tmp_path.glob("out.lcm.*[!x]"))
