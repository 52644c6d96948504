"""Logs of several files, plain or compressed, read as one."""

import fcntl
import os
import random
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.lcm import log_file, log_parts
from fwk.lcm.event_log import LogError, LogReader, LogWriter
from fwk.lcm.log_file import LogFile, locked
from fwk.lcm.log_parts import LogBytes, exists, is_later_part, parts_of
from fwk.lcm.seekable_zstd import FRAME_BYTES, CompressedFile, CompressedFileError, compress
from fwk.recording.part_compressor import compress_part

EVENTS = 40


def split_log(path: Path, parts: int = 4, fill: int = 100) -> list[bytes]:
    """Writes a log of several parts; returns the contents of its events."""
    contents = [b"%d" % number + bytes(fill) for number in range(EVENTS)]
    with LogWriter(path, pytest.fail) as log:
        for number, data in enumerate(contents):
            if number and number % (EVENTS // parts) == 0:
                log.split()
            log.append("a/b", data, number)
    return contents


def contents_of(path: Path) -> list[bytes]:
    return [event.data for event in LogReader(path)]


def test_parts_are_read_as_one_log(tmp_path: Path) -> None:
    log = tmp_path / "log.lcm"
    contents = split_log(log)
    assert [part.name for part in parts_of(log)] == ["log.lcm", "log.lcm.01", "log.lcm.02", "log.lcm.03"]
    assert contents_of(log) == contents
    assert [event.number for event in LogReader(log)] == list(range(EVENTS))
    assert contents_of(tmp_path / "log.lcm.02") == contents[20:30]
    assert (is_later_part(tmp_path / "log.lcm.02"), is_later_part(log)) == (True, False)


def test_compressed_parts_are_read_as_plain_ones(tmp_path: Path) -> None:
    log = tmp_path / "log.lcm"
    contents = split_log(log, fill=FRAME_BYTES // 3)
    with LogBytes(log) as plain:
        size_bytes, mtime_ns = plain.size_bytes, plain.mtime_ns
    for part in parts_of(log)[:3]:
        assert compress_part(part)
    assert sorted(file.name for file in tmp_path.iterdir()) == [
        *("log.lcm.01.zst", "log.lcm.02.zst", "log.lcm.03", "log.lcm.zst")
    ]
    assert contents_of(log) == contents_of(tmp_path / "log.lcm.zst") == contents
    assert contents_of(tmp_path / "log.lcm.01") == contents[10:20]
    assert exists(log)
    with LogBytes(log) as made:
        assert (made.size_bytes, made.mtime_ns) == (size_bytes, mtime_ns)


def test_reading_goes_on_when_a_part_is_compressed_meanwhile(tmp_path: Path) -> None:
    log = tmp_path / "log.lcm"
    contents = split_log(log, fill=FRAME_BYTES // 3)
    reader = iter(LogReader(log))
    found = [next(reader).data]
    for part in parts_of(log):
        assert compress_part(part)
    assert found + [event.data for event in reader] == contents


def test_a_part_may_be_compressed_while_it_is_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    log = tmp_path / "log.lcm"
    contents = split_log(log)
    waiting, right = set(parts_of(log)), log_file.opened

    def opened(path: Path) -> LogFile:
        if path in waiting:
            waiting.remove(path)
            assert compress_part(path)
        return right(path)

    monkeypatch.setattr(log_parts, "opened", opened)
    assert contents_of(log) == contents
    assert not waiting


def test_damage_in_a_compressed_part_costs_one_frame(tmp_path: Path) -> None:
    log = tmp_path / "log.lcm"
    contents = split_log(log, parts=1, fill=FRAME_BYTES // 4)
    compress_part(log)
    made = bytearray((tmp_path / "log.lcm.zst").read_bytes())
    begin = made.index(b"\x28\xb5\x2f\xfd", 1)  # the second frame
    made[begin + 6 : begin + 30] = bytes(24)
    (tmp_path / "log.lcm.zst").write_bytes(made)
    reader = LogReader(log)
    found = [event.data for event in reader]
    assert contents[:3] == found[:3]
    assert contents[10:] == found[-30:]
    assert reader.skipped_bytes > 0


@pytest.mark.parametrize("name", ["log.lcm.01", "log.lcm.1", "log.lcm.02"])
def test_a_log_of_its_own_is_not_taken_for_a_part(tmp_path: Path, name: str) -> None:
    contents = split_log(tmp_path / "log.lcm", parts=1)
    split_log(tmp_path / name, parts=1)
    assert contents_of(tmp_path / "log.lcm") == contents
    assert not is_later_part(tmp_path / name)


def test_a_new_log_replaces_the_old_one_with_its_parts(tmp_path: Path) -> None:
    split_log(tmp_path / "log.lcm")
    compress_part(tmp_path / "log.lcm.02")
    shutil.copy(tmp_path / "log.lcm", tmp_path / "other.lcm.01")
    contents = split_log(tmp_path / "log.lcm", parts=2)
    assert contents_of(tmp_path / "log.lcm") == contents
    assert sorted(file.name for file in tmp_path.iterdir()) == ["log.lcm", "log.lcm.01", "other.lcm.01"]


def test_a_part_that_a_run_writes_is_not_compressed(tmp_path: Path) -> None:
    with LogWriter(tmp_path / "log.lcm", pytest.fail) as log:
        log.append("a", b"1", 0)
        finished = log.split()
        log.append("a", b"2", 0)
        log.flush()
        assert finished == tmp_path / "log.lcm"
        assert [compress_part(part) for part in parts_of(tmp_path / "log.lcm")] == [True, False]
        assert contents_of(tmp_path / "log.lcm") == [b"1", b"2"]
    with open(tmp_path / "log.lcm.01", "rb") as file:
        assert locked(file.fileno(), fcntl.LOCK_EX)


def test_only_files_of_logs_are_compressed(tmp_path: Path) -> None:
    device, text, folder = tmp_path / "device", tmp_path / "notes.txt", tmp_path / "folder"
    os.mkfifo(device)
    text.write_text("this is not a log")
    folder.mkdir()
    for path in (device, text, folder, tmp_path / "missing"):
        with pytest.raises(LogError, match="is not the file of an LCM log; it stays as it is"):
            compress_part(path)
    assert sorted(tmp_path.iterdir()) == [device, folder, text]
    assert device.is_fifo()


def test_without_room_for_a_part_the_newest_goes_on(tmp_path: Path) -> None:
    (tmp_path / "log.lcm.01").mkdir()
    contents = split_log(tmp_path / "log.lcm", parts=2)
    assert contents_of(tmp_path / "log.lcm") == contents


def test_a_compressed_file_is_read_at_any_position(tmp_path: Path) -> None:
    content = random.Random(1).randbytes(3 * FRAME_BYTES + 17)
    (tmp_path / "a").write_bytes(content)
    compress(tmp_path / "a", tmp_path / "a.zst")
    made = CompressedFile(tmp_path / "a.zst")
    for position in (0, 1, FRAME_BYTES - 1, FRAME_BYTES, 2 * FRAME_BYTES + 5, len(content) - 1, len(content), 1 << 40):
        assert made.read(position, 1000) == content[position : position + 1000]
    assert made.read(FRAME_BYTES - 5, FRAME_BYTES + 9) == content[FRAME_BYTES - 5 : 2 * FRAME_BYTES + 4]
    made.close()
    import zstandard

    plain = zstandard.ZstdDecompressor().stream_reader((tmp_path / "a.zst").read_bytes(), read_across_frames=True)
    assert plain.read() == content


@pytest.mark.parametrize("content", [b"", b"text", bytes(9), b"\xff" * 8 + (0x8F92EAB1).to_bytes(4, "little")])
def test_a_file_without_a_table_is_named(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "log.lcm.zst").write_bytes(content)
    with pytest.raises(CompressedFileError, match="no table of its frames"):
        CompressedFile(tmp_path / "log.lcm.zst")
    with pytest.raises(LogError, match=r"log.lcm.zst: cannot read: .* zstd -d FILE"):
        LogReader(tmp_path / "log.lcm")


def test_a_missing_library_is_named(tmp_path: Path) -> None:
    (tmp_path / "log.lcm.zst").write_bytes(b"1")
    program = (
        "import sys, pathlib; sys.modules['zstandard'] = None\n"
        "from fwk.lcm.event_log import LogReader\n"
        f"LogReader(pathlib.Path({str(tmp_path / 'log.lcm')!r}))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert "needs another library: pip install 'fwk[compress]'" in done.stderr
