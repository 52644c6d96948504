"""The ring between real processes: no torn or wrong frame under load, and no process suffers from another's death."""

import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from fwk.component.images import SLOTS, Ring

ROOT = Path(__file__).parents[3]
TIMEOUT_S = 40.0

COMMON = """
import os, sys, zlib
import numpy as np
from fwk.component.images import SLOTS, Ring

SIZE = 200_000
NOISE = np.random.default_rng(1).integers(0, 256, SIZE - 12, np.uint8)
ring, newest = Ring(int(sys.argv[1])), int(sys.argv[2])

def made(number):
    body = NOISE ^ np.uint8(number % 251)
    head = number.to_bytes(8, "big") + zlib.crc32(body).to_bytes(4, "big")
    return np.concatenate([np.frombuffer(head, np.uint8), body])

def check(number, pixels):
    found, crc = int.from_bytes(pixels[:8].tobytes(), "big"), int.from_bytes(pixels[8:12].tobytes(), "big")
    if found != number or crc != zlib.crc32(pixels[12:]):
        sys.exit(f"torn: asked for frame {number}, got frame {found}, checksum {crc == zlib.crc32(pixels[12:])}")

def newest_number():
    return int.from_bytes(os.pread(newest, 8, 0), "big")
"""

WRITER = """
frames = [made(number) for number in range(251)]
number = newest_number()
print("ready", flush=True)
while True:
    number += 1
    pixels = frames[number % 251]
    pixels[:8] = np.frombuffer(number.to_bytes(8, "big"), np.uint8)
    ring.put(number, pixels.reshape(500, 400))
    os.pwrite(newest, number.to_bytes(8, "big"), 0)
"""

READER = """
whole = lost = 0
print("ready", flush=True)
while whole < 300 or lost < 20:
    number = newest_number() - SLOTS + 1 + whole % SLOTS  # from the one that is overwritten next to the newest
    pixels = ring.get(number, SIZE) if number > 0 else None
    if pixels is None:
        lost += number > 0
    else:
        check(number, pixels)
        whole += 1
print(whole, lost, flush=True)
"""

Start = Callable[[str], subprocess.Popen[str]]


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Start]:
    """Starts a process that maps the ring; returns it with a file that holds the number of the newest frame."""
    ring = Ring.create("stress")
    started: list[subprocess.Popen[str]] = []
    with open(tmp_path / "newest", "w+b") as newest:

        def run(work: str) -> subprocess.Popen[str]:
            descriptors = (ring.descriptor, newest.fileno())
            command = [sys.executable, "-c", COMMON + work, *map(str, descriptors)]
            process = subprocess.Popen(command, cwd=ROOT, pass_fds=descriptors, text=True, stdout=-1, stderr=-1)
            started.append(process)
            assert process.stdout
            assert process.stdout.readline() == "ready\n", process.communicate()[1]
            return process

        yield run
        for process in started:
            process.kill()
            process.communicate()


def result(reader: subprocess.Popen[str]) -> tuple[int, int]:
    """Returns how many frames a reader saw whole, and how many were overwritten before or during the read."""
    out, errors = reader.communicate(timeout=TIMEOUT_S)
    assert reader.returncode == 0, errors
    whole, lost = map(int, out.split())
    return whole, lost


@pytest.mark.slow
def test_readers_see_whole_frames_under_fast_overwriting(start: Start) -> None:
    start(WRITER)
    for whole, lost in [result(reader) for reader in [start(READER) for _ in range(4)]]:
        assert whole >= 300
        assert lost >= 20


@pytest.mark.slow
def test_a_reader_killed_during_a_read_stops_no_process(start: Start) -> None:
    writer, *victims, survivor = start(WRITER), start(READER), start(READER), start(READER)
    for victim in victims:
        victim.send_signal(signal.SIGKILL)
        victim.wait(TIMEOUT_S)
    assert result(survivor)[0] >= 300
    assert result(start(READER))[0] >= 300  # a reader that comes later
    assert writer.poll() is None


@pytest.mark.slow
def test_killed_writer_leaves_no_torn_frame(start: Start) -> None:
    readers = [start(READER) for _ in range(2)]
    for _ in range(3):
        writer = start(WRITER)
        writer.send_signal(signal.SIGKILL)
        writer.wait(TIMEOUT_S)
    start(WRITER)
    assert all(result(reader)[0] >= 300 for reader in readers)


NEIGHBOUR = """
print("ready", flush=True)
seen, theirs = 0, Ring.of_process(os.getppid(), "stress")
while seen < 200:
    number, pixels = theirs.newest() or (0, None)
    if number:
        check(number, pixels.reshape(-1))
        seen += 1
print(seen, Ring.of_process(os.getppid(), "none"), flush=True)
"""


def test_outside_viewer_finds_the_ring_and_its_newest_frame(start: Start) -> None:
    neighbour, _ = start(NEIGHBOUR), start(WRITER)
    out, errors = neighbour.communicate(timeout=TIMEOUT_S)
    assert out == "200 None\n", errors


@pytest.mark.parametrize("shape", [(6, 4, 3), (6, 4)])
def test_the_newest_frame_is_available_with_its_shape(shape: tuple[int, ...]) -> None:
    ring = Ring.create("newest")
    assert ring.newest() is None
    for number in range(1, 8):
        ring.put(number, np.full(shape, number, np.uint8))
    newest = ring.newest()
    assert newest is not None
    assert (newest[0], newest[1].shape, int(newest[1].max())) == (7, shape, 7)


def test_a_ring_keeps_as_many_frames_as_it_has_slots() -> None:
    ring = Ring.create("slots")
    for number in range(1, SLOTS + 3):
        ring.put(number, np.full((2, 2), number, np.uint8))
    assert ring.get(2, 4) is None
    assert [int(pixels[0]) for n in range(3, SLOTS + 3) if (pixels := ring.get(n, 4)) is not None] == [3, 4, 5, 6]
