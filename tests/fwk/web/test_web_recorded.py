"""Recordings whose runs go on: their ticks are found, and their contents told, from parts of the log."""

import json
from pathlib import Path

import pytest

from fwk.lcm.event_log import LogError, LogWriter
from fwk.model import names
from fwk.recording.log_info import log_info
from fwk.recording.play.timeline import Timeline
from fwk.web import recorded_ticks
from fwk.web.recorded import LOG, RecordedRun
from fwk.web.recorded_ticks import RecordedTicks, contents
from lcmtypes.core import log_t, picture_t, plan_t, tick_record_t
from tests.fwk.recording.play.play_logs import heard, recording

LINE = dict.fromkeys(log_t.__slots__, 0) | {"level": "info", "component": "supervisor", "tick": 7, "text": "goal"}
NOTE = json.dumps(LINE | {"file": names.NOTE}) + "\n"


@pytest.fixture(params=[1, 100, 1 << 20])
def parts(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Reads logs in parts of this size."""
    for name in ("_SMALL_BYTES", "_NEAR_BYTES", "_END_BYTES"):
        monkeypatch.setattr(recorded_ticks, name, request.param)


@pytest.mark.usefixtures("parts")
def test_every_tick_is_found_where_it_begins(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    timeline, ticks = Timeline(log), RecordedTicks(log)
    for tick in (10, 1, 7, 4, 2, 3, 5, 6, 8, 9):
        position = ticks.position(tick)
        assert position is not None
        assert timeline.at(position).tick == tick, tick
    assert ticks.position(12) is None


@pytest.mark.usefixtures("parts")
def test_a_recording_is_shown_while_its_run_goes_on(tmp_path: Path) -> None:
    log = recording(tmp_path / LOG)
    (tmp_path / "fwk.log.jsonl").write_text(NOTE)
    known, found = log_info(log), contents(log)
    assert (found.ticks, found.events, found.size_bytes) == (known.ticks, known.events, known.size_bytes)
    was, now = (info.channels["cyan1/odometry"] for info in (known, found))
    assert (now.types, now.messages, now.rate_hz) == (was.types, was.messages, was.rate_hz)
    run = RecordedRun(tmp_path)
    assert run.last_tick == 10
    assert [run.time_us(tick) for tick in (1, 4)] == [Timeline(log).of_tick(tick).time_us for tick in (1, 4)]
    assert run.newest(7)["cyan1/odometry"].header.tick == 7
    assert run.newest(3)["cyan1/odometry"].header.tick == 3


def test_bookmarks_of_a_run_that_goes_on_are_shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(recorded_ticks, "_SMALL_BYTES", 1)
    log = recording(tmp_path / LOG)
    (tmp_path / "fwk.log.jsonl").write_text(NOTE)
    assert [(note.tick, note.text) for note in contents(log).notes] == [(7, "goal")]


def test_a_tick_seen_again_shows_its_own_picture(tmp_path: Path) -> None:
    with LogWriter(tmp_path / LOG, print) as log:
        log.append("fwk/plan", plan_t().encode(), 0)
        for tick in range(1, 11):
            if tick >= 3:
                log.append("fwk/frame", picture_t(camera="cyan1/image", frame=tick).encode(), tick)
            log.append("fwk/record", tick_record_t(tick=tick).encode(), tick)
    run = RecordedRun(tmp_path)
    for tick in (9, 4, 9, 10, 4):
        run.newest(tick)
        picture = run.picture("cyan1/image", tick)
        assert picture is not None
        assert picture.frame == tick
    assert run.picture("cyan1/image", 2) is None


def test_logs_without_ticks_and_empty_ones_are_told_apart(tmp_path: Path) -> None:
    assert contents(heard(tmp_path / "heard")).ticks == (1, 10)
    LogWriter(tmp_path / "log", print).close()
    with pytest.raises(LogError, match="no message in it"):
        contents(tmp_path / "log")
