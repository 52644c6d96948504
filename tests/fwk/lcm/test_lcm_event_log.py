"""The log writer and reader against LCM's own, and with torn, damaged and hostile files."""

import os
import random
import resource
import struct
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import lcm
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fwk.lcm.event_log import Event, LogError, LogReader, LogWriter

EVENTS = [Event(i, 1_000_000 + 50_000 * i, f"cyan1/c{i % 3}", bytes([i % 256]) * (i * 37 % 500)) for i in range(60)]


def refuse(text: str) -> None:
    raise AssertionError(f"nothing to report was expected: {text}")


def write(path: Path, events: list[Event] = EVENTS) -> Path:
    with LogWriter(path, refuse, buffer_bytes=1000) as writer:
        for event in events:
            writer.append(event.channel, event.data, event.time_us)
    return path


def starts(path: Path) -> list[int]:
    """Returns the offset of each event."""
    found, position = [], 0
    data = path.read_bytes()
    while position < len(data):
        found.append(position)
        channel_bytes, data_bytes = struct.unpack_from(">II", data, position + 20)
        position += 28 + channel_bytes + data_bytes
    return found


def test_lcm_reads_files_of_the_writer(tmp_path: Path) -> None:
    read = [Event(e.eventnum, e.timestamp, e.channel, e.data) for e in lcm.EventLog(str(write(tmp_path / "log")))]
    assert read == EVENTS


def test_the_reader_reads_files_of_lcm(tmp_path: Path) -> None:
    log = lcm.EventLog(str(tmp_path / "log"), "w")
    for event in EVENTS:
        log.write_event(event.time_us, event.channel, event.data)
    log.close()
    reader = LogReader(tmp_path / "log")
    assert list(reader) == EVENTS
    assert reader.skipped_bytes == 0
    assert (tmp_path / "log").read_bytes() == write(tmp_path / "own").read_bytes()


def test_an_empty_file_is_an_empty_log(tmp_path: Path) -> None:
    assert list(LogReader(write(tmp_path / "log", []))) == []


def test_an_event_larger_than_the_readers_window_is_read(tmp_path: Path) -> None:
    large = [Event(0, 1, "a", b"x" * (3 << 20)), Event(1, 2, "b", b"y")]
    assert list(LogReader(write(tmp_path / "log", large))) == large


@pytest.mark.parametrize("cut", range(1, 70))
def test_a_torn_tail_costs_the_last_event_only(tmp_path: Path, cut: int) -> None:
    path = write(tmp_path / "log", [*EVENTS[:5], Event(5, 9, "channel", b"z" * 40)])
    path.write_bytes(path.read_bytes()[:-cut])
    reader = LogReader(path)
    assert list(reader) == EVENTS[:5]
    assert reader.skipped_bytes == 28 + len("channel") + 40 - cut


@pytest.mark.parametrize("offset", [20, 22, 23, 24, 26, 27])
def test_a_damaged_length_costs_one_event(tmp_path: Path, offset: int) -> None:
    path = write(tmp_path / "log")
    begin, end = starts(path)[10:12]
    data = bytearray(path.read_bytes())
    data[begin + offset] ^= 1
    path.write_bytes(data)
    reader = LogReader(path)
    assert list(reader) == EVENTS[:10] + EVENTS[11:]
    assert reader.skipped_bytes == end - begin


def test_a_damaged_sync_word_costs_that_event_and_the_one_before(tmp_path: Path) -> None:
    path = write(tmp_path / "log")
    data = bytearray(path.read_bytes())
    data[starts(path)[10] + 1] ^= 1
    path.write_bytes(data)
    assert list(LogReader(path)) == EVENTS[:9] + EVENTS[11:]


@pytest.mark.parametrize("end", [3000, *range((1 << 20) - 4, (1 << 20) + 2), 3 << 20])
def test_reading_goes_on_behind_foreign_bytes(tmp_path: Path, end: int) -> None:
    """The damage ends at byte `end`, also where the reader's buffer cuts the next sync word."""
    path = write(tmp_path / "log")
    data, before, begin = path.read_bytes(), *starts(path)[9:11]
    path.write_bytes(data[:begin] + b"\xed" * (end - begin) + data[begin:])
    reader = LogReader(path)
    assert list(reader) == EVENTS[:9] + EVENTS[10:]
    assert reader.skipped_bytes == end - before


@given(st.lists(st.one_of(st.binary(max_size=60), st.just(b"\xed\xa1\xda\x01"), st.just(bytes(30)))))
def test_no_bytes_make_the_reader_crash(tmp_path_factory: pytest.TempPathFactory, pieces: list[bytes]) -> None:
    path = tmp_path_factory.getbasetemp() / "hostile.lcmlog"
    path.write_bytes(b"".join(pieces))
    reader = LogReader(path)
    used = sum(28 + len(event.channel.encode()) + len(event.data) for event in reader if event.channel.isascii())
    assert used + reader.skipped_bytes <= path.stat().st_size


def test_a_file_of_sync_words_alone_is_skipped(tmp_path: Path) -> None:
    path = tmp_path / "log"
    path.write_bytes(b"\xed\xa1\xda\x01" * 50_000)
    reader = LogReader(path)
    assert list(reader) == []
    assert reader.skipped_bytes == 200_000


def test_a_log_with_random_damage_gives_only_true_events(tmp_path: Path) -> None:
    path, dice = write(tmp_path / "log"), random.Random(5)
    data = bytearray(path.read_bytes())
    for begin in starts(path)[::6]:
        data[begin + dice.choice([0, 3, 20, 24])] ^= 0x40
    path.write_bytes(data)
    read = list(LogReader(path))
    assert set(read) < set(EVENTS)
    assert len(read) >= len(EVENTS) - 20


def test_a_killed_writer_leaves_a_readable_log(tmp_path: Path) -> None:
    program = (
        "import os, signal, sys; from pathlib import Path; from fwk.lcm.event_log import LogWriter\n"
        "writer = LogWriter(Path(sys.argv[1]), print, 300)\n"
        "[writer.append('a', bytes(100), i) for i in range(50)]\n"
        "os.kill(os.getpid(), signal.SIGKILL)"
    )
    killed = subprocess.run([sys.executable, "-c", program, str(tmp_path / "log")], check=False)
    assert killed.returncode == -9
    read = list(LogReader(tmp_path / "log"))
    assert [event.time_us for event in read] == list(range(len(read)))
    assert len(read) >= 48


def test_full_disk_is_reported_once_and_writing_resumes(tmp_path: Path) -> None:
    said: list[str] = []
    writer = LogWriter(tmp_path / "log", said.append, buffer_bytes=1)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    writer.append("a", bytes(100), 1)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (200, before[1]))  # Python ignores SIGXFSZ: writing fails instead
        writer.append("a", bytes(100), 2)
        writer.append("a", bytes(100), 3)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    writer.append("a", b"shorter than what was torn", 4)
    writer.close()
    reader = LogReader(tmp_path / "log")
    assert [(event.number, event.time_us) for event in reader] == [(0, 1), (3, 4)]
    assert reader.skipped_bytes == 0
    assert (writer.events, writer.dropped) == (4, 2)
    assert len(said) == 2
    assert "File too large" in said[0]
    assert "the disk has room again; 2 messages are missing" in said[1]


def test_a_file_that_another_program_cuts_is_named(tmp_path: Path) -> None:
    reports: list[str] = []
    with LogWriter(tmp_path / "log", reports.append) as writer:
        for event in EVENTS[:20]:
            writer.append(event.channel, event.data, event.time_us)
        writer.flush()
        size_bytes, kept_bytes = (tmp_path / "log").stat().st_size, starts(tmp_path / "log")[5]
        os.truncate(tmp_path / "log", kept_bytes)
        for event in EVENTS[20:]:
            writer.append(event.channel, event.data, event.time_us)
        writer.flush()
        os.truncate(tmp_path / "log", size_bytes)
    cut_bytes = size_bytes - kept_bytes
    assert reports[0] == f"{tmp_path / 'log'}: another program has cut {cut_bytes} bytes off the recording"
    assert len(reports) == 2
    assert writer.cut_bytes > cut_bytes
    assert [*LogReader(tmp_path / "log")][:10] == [*EVENTS[:5], *EVENTS[20:25]]


def test_a_disk_full_from_the_beginning_stops_no_process() -> None:
    said: list[str] = []
    writer = LogWriter(Path("/dev/full"), said.append, buffer_bytes=1)
    for number in range(5):
        writer.append("a", b"data", number)
    writer.close()
    assert (writer.dropped, len(said)) == (5, 1)
    assert said[0].startswith("/dev/full: cannot record: No space left on device")


def test_refusals_name_the_file(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    os.mkfifo(tmp_path / "pipe")
    cases: list[tuple[Callable[[], object], str]] = [
        (lambda: LogReader(tmp_path / "none"), f"{tmp_path}/none: cannot read: No such file"),
        (lambda: LogReader(tmp_path), f"{tmp_path}: not an ordinary file"),
        (lambda: LogWriter(tmp_path / "file" / "log", refuse), f"{tmp_path}/file/log: cannot write a log there: "),
        (lambda: LogWriter(tmp_path / "pipe", refuse), f"{tmp_path}/pipe: cannot write a log there: a pipe cannot be"),
    ]
    for make, text in cases:
        with pytest.raises(LogError) as caught:
            make()
        assert str(caught.value).startswith(text)


def test_a_message_that_lcm_cannot_hold_is_not_written(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log", refuse) as writer:
        for channel in ("", "x" * 1000):
            with pytest.raises(ValueError, match="not an LCM event"):
                writer.append(channel, b"", 0)
    assert list(LogReader(tmp_path / "log")) == []
