"""Moments of recordings and other logs."""

from pathlib import Path

import pytest

from fwk.lcm.event_log import LogError, LogWriter
from fwk.recording.log_info import log_info
from fwk.recording.play.timeline import MomentError, Timeline
from lcmtypes.core import log_t, plan_t
from tests.fwk.recording.play.play_logs import foreign, heard, recording
from tests.fwk.recording.recording_made import PERIOD_US, write


def test_a_recorded_tick_begins_after_the_record_before(tmp_path: Path) -> None:
    timeline = Timeline(recording(tmp_path / "log", notes={4: "ball taken away", 7: "ball back"}))
    events = [event.channel for event, _ in timeline.events_from(timeline.find("4"))]
    assert events[:3] == ["cyan1/odometry", "fwk/log", "fwk/record"]
    assert timeline.begin.tick == 1
    assert timeline.length_s == 0.5
    assert [timeline.find(text).tick for text in ("10", "0.22s", "0s", "taken", "ball", "back")] == [10, 4, 1, 4, 4, 7]


def test_ticks_of_a_heard_log_are_those_of_its_headers(tmp_path: Path) -> None:
    timeline = Timeline(heard(tmp_path / "log"))
    assert timeline.begin.tick == 1
    assert timeline.find("0.1s").tick == 3
    fourth = timeline.of_tick(4)
    assert next(event.channel for event, _ in timeline.events_from(fourth)) == "cyan1/odometry"
    assert timeline.at(fourth.position) == fourth
    assert timeline.at(fourth.position - 1).tick == 3
    fifth = timeline.after(fourth.position)
    assert fifth is not None
    assert (fifth.tick, timeline.after(timeline.of_tick(10).position)) == (5, None)


def test_a_log_without_headers_has_steps_of_50_ms(tmp_path: Path) -> None:
    timeline = Timeline(foreign(tmp_path / "log"))
    second = timeline.after(timeline.begin.position)
    assert second is not None
    assert (second.tick, second.time_us - timeline.begin.time_us) == (None, 60_000)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("11", "no tick 11; the last one is 10"),
        ("0.6s", "no 0.6s in it; it ends at 0.5s"),
        ("goal", "no bookmark 'goal' ('fwk note' writes them); there are: 'kick-off'"),
    ],
)
def test_a_moment_that_the_log_lacks_is_named(tmp_path: Path, text: str, reason: str) -> None:
    timeline = Timeline(recording(tmp_path / "log", notes={2: "kick-off"}))
    with pytest.raises(MomentError) as found:
        timeline.find(text)
    assert str(found.value).startswith(f"{tmp_path}/log: {reason}")


def test_a_tick_of_a_log_without_ticks_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MomentError, match="no ticks in it; choose a moment by time"):
        Timeline(foreign(tmp_path / "log")).find("3")


def test_an_empty_log_cannot_be_played(tmp_path: Path) -> None:
    LogWriter(tmp_path / "log", print).close()
    with pytest.raises(LogError, match="nothing to play: no message in it"):
        Timeline(tmp_path / "log")


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"no log", "not an LCM log: no event in it; it has 6 bytes"),
        (None, "cut off within its first event; it has 40"),
    ],
)
def test_a_file_that_is_no_log_cannot_be_played(tmp_path: Path, content: bytes | None, reason: str) -> None:
    path = recording(tmp_path / "log")
    path.write_bytes(path.read_bytes()[:40] if content is None else content)
    with pytest.raises(LogError, match=reason):
        Timeline(path)


def test_ticks_before_damage_and_after_it_are_found(tmp_path: Path) -> None:
    log = recording(tmp_path / "log")
    data = bytearray(log.read_bytes())
    place = Timeline(log).of_tick(5).position
    data[place : place + 4] = b"????"
    log.write_bytes(data)
    timeline = Timeline(log)
    assert timeline.find("7").time_us == 7 * PERIOD_US


@pytest.mark.parametrize("file", ["fwk/supervisor/control.py", "fwk/supervisor/control/control.py"])
def test_notes_of_recordings_before_the_mark_are_bookmarks(tmp_path: Path, file: str) -> None:
    texts = ["asked to stop a/b", "the ball: process by hand", "a/b: process 17, an external process, takes its place"]
    lines = [log_t(component="supervisor", file=file, text=text).encode() for text in texts]
    log = write(tmp_path / "log", [("fwk/plan", plan_t().encode(), 0), *(("fwk/log", line, 0) for line in lines)])
    assert Timeline(log).find("ball") == Timeline(log).begin
    assert [note.text for note in log_info(log).notes] == ["the ball: process by hand"]


def test_only_lines_of_fwk_note_are_bookmarks(tmp_path: Path) -> None:
    other = log_t()
    other.component, other.file, other.text = "supervisor", "fwk/supervisor/processes/hosts.py", "a waits for b"
    log = write(tmp_path / "log", [("fwk/plan", plan_t().encode(), 0), ("fwk/log", other.encode(), 0)])
    with pytest.raises(MomentError, match="no bookmark 'waits'"):
        Timeline(log).find("waits")
