"""Targets of the gateway's messages, without a gateway."""

import socket
from dataclasses import replace
from pathlib import Path

import pytest

from fwk import Component, Writes, channel
from fwk.lcm.event_log import LogReader
from fwk.lcm.log_file import is_compressed
from fwk.lcm.log_parts import parts_of
from fwk.logs.rotating import RotatingFile
from fwk.logs.text_file import TextLog
from fwk.model.sections import RecordPlan
from fwk.recording.log_info import log_info
from fwk.recording.sinks import ChosenChannels, Display, Newest, Recorder
from fwk.testing.plans import plan_of
from lcmtypes.core import excerpt_t, log_t
from lcmtypes.robot import imu_t
from tests.harness.runs import pause


class World(Component):
    stage = "pre_loop"
    truth: Writes[imu_t] = channel("world/truth")
    other: Writes[imu_t] = channel("robot/other")


PLAN = replace(plan_of({"world/simulator": World}), scoreboard_channels=("world/truth",))


def line(text: str) -> bytes:
    made = log_t()
    made.component, made.text, made.level, made.tick, made.time_us = "r/base", text, log_t.WARNING, 3, 150_000
    made.file, made.line = "base.py", 7
    return made.encode()


def received(end: socket.socket) -> list[bytes]:
    end.setblocking(False)
    found: list[bytes] = []
    while True:
        try:
            packet = end.recv(1 << 16)
        except BlockingIOError:
            return found
        if not packet:
            return found
        found.append(packet)


def test_the_recorder_keeps_order_and_logical_time(tmp_path: Path) -> None:
    recorder = Recorder(PLAN, tmp_path / "a.lcm", pytest.fail)
    for number in range(100):
        recorder.message("world/truth", b"%d" % number, number * 50_000)
        recorder.tick()
    recorder.close()
    plan, *events = LogReader(tmp_path / "a.lcm")
    assert plan.channel == "fwk/plan"
    assert [(event.channel, event.data, event.time_us) for event in events] == [
        ("world/truth", b"%d" % number, number * 50_000) for number in range(100)
    ]


def test_a_choice_of_channels_is_recorded(tmp_path: Path) -> None:
    record = RecordPlan(channels=("world", "a/*"), exclude=("a/image",))
    recorder = ChosenChannels(Recorder(replace(PLAN, record=record), tmp_path / "a.lcm", pytest.fail), record)
    for name in ("world/truth", "a/pose", "a/image", "b/pose", "fwk/log"):
        recorder.message(name, b"1", 0)
    recorder.close()
    events = list(LogReader(tmp_path / "a.lcm"))
    assert [event.channel for event in events] == ["fwk/plan", "fwk/excerpt", "world/truth", "a/pose", "fwk/log"]
    assert excerpt_t.decode(events[1].data).text == "channels world a/*, without a/image"


def test_a_recording_ends_at_its_limit_after_a_tick(tmp_path: Path) -> None:
    said: list[str] = []
    limited = replace(PLAN, record=RecordPlan(size_gb=1e-5))
    recorder = Recorder(limited, tmp_path / "a.lcm", said.append)
    for tick in range(40):
        for part in (b"first of", b"last of"):
            recorder.message("world/truth", part + b" %d" % tick + bytes(500), tick)
        recorder.tick()
    recorder.close()
    events = list(LogReader(tmp_path / "a.lcm"))
    assert events[-1].data.startswith(b"last of")
    assert 10_000 <= (tmp_path / "a.lcm").stat().st_size < 11_500
    assert said == [
        f"{tmp_path}/a.lcm: the recording ends: it has reached record.size_gb; the run goes on",
        f"{tmp_path}/a.lcm: {81 - len(events)} messages came after the end of the recording",
    ]
    assert log_info(tmp_path / "a.lcm").from_index


@pytest.mark.parametrize(
    ("limit", "parts"), [(RecordPlan(split_s=0.5, compress=True), 4), (RecordPlan(split_mb=0.001, compress=True), 5)]
)
def test_a_recording_in_parts_is_the_same_log(tmp_path: Path, limit: RecordPlan, parts: int) -> None:
    for name, record in (("whole.lcm", RecordPlan()), ("parts.lcm", limit)):
        recorder = Recorder(replace(PLAN, record=record), tmp_path / name, pytest.fail)
        for tick in range(40):
            for part in (b"first of", b"last of"):
                recorder.message("world/truth", part + b" %d" % tick, tick * 50_000)
            recorder.tick()
        while record.compress and not (tmp_path / "parts.lcm.zst").exists():
            pause()  # the recording ends long after its first part
        recorder.close()
    (_, *whole), (_, *split) = LogReader(tmp_path / "whole.lcm"), LogReader(tmp_path / "parts.lcm")
    assert split == whole
    files = parts_of(tmp_path / "parts.lcm")
    assert len(files) == parts
    assert all(is_compressed(file) for file in files)
    assert all(next(iter(LogReader(file))).data.startswith(b"first of") for file in files[1:])
    info = log_info(tmp_path / "parts.lcm")
    assert (info.from_index, info.events, log_info(tmp_path / "parts.lcm", check=True).changed) == (True, 81, [])


def test_the_first_ticks_reach_the_file_before_the_end(tmp_path: Path) -> None:
    recorder = Recorder(PLAN, tmp_path / "a.lcm", pytest.fail)
    recorder.message("world/truth", b"1", 0)
    recorder.tick()
    assert [event.channel for event in LogReader(tmp_path / "a.lcm")] == ["fwk/plan", "world/truth"]
    recorder.close()


def test_the_text_log_has_one_line_for_each_message(tmp_path: Path) -> None:
    log = TextLog(RotatingFile(tmp_path / "fwk.log", 1000, 1, pytest.fail))
    log.message("world/truth", b"\0" * 100, 0)
    log.message("fwk/log", line("wheels are hot"), 0)
    log.close()
    (written,) = (tmp_path / "fwk.log").read_text().splitlines()
    assert "tick 3 0.150 s warning r/base base.py:7: wheels are hot" in written


def test_display_gets_all_lines_and_the_newest_state() -> None:
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    display = Display(PLAN, ours, pytest.fail)
    display.message("fwk/log", line("hello"), 0)
    for number in range(50):
        display.message("world/truth", b"%d" % number, 0)
        display.message("robot/other", b"not shown", 0)
    assert [packet.partition(b"\0")[0] for packet in received(theirs)] == [b"fwk/log"]
    display.close()
    assert received(theirs) == [b"world/truth\x0049"]
    theirs.close()


def test_a_display_that_does_not_read_delays_no_process() -> None:
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    reported: list[str] = []
    display = Display(PLAN, ours, reported.append)
    for _ in range(10_000):
        display.message("fwk/log", line("flood"), 0)
    assert not reported
    theirs.close()
    for _ in range(3):
        display.message("fwk/log", line("into the void"), 0)
    display.close()
    assert reported == ["the display has ended; the run goes on without it"]


def test_the_newest_messages_are_passed_on_at_the_end() -> None:
    ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
    newest = Newest(PLAN, ours, lambda: 7)
    for number in range(3):
        newest.message("world/truth", b"%d" % number, 0)
        newest.message("robot/other", b"x", 0)
    assert received(theirs) == []
    newest.close()
    assert received(theirs) == [b"world/truth\x002", b"fwk/lost\x007"]
    for each in (ours, theirs):
        each.close()
