"""Recorded frames: replay of the readers of a device's frames; without recorded frames, a clear refusal."""

import os
import re
import signal
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
import pytest

from fwk.lcm.event_log import LogReader
from fwk.recording.pictures import FRAME, pictures_in
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import difference
from tests.harness.runs import PortBlock, fill, fwk, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
name: eyes
public_url: {url}
components:
  r/camera: {{use: "eyes:Device"}}
  g/camera: {{use: "eyes:Grey"}}
  a/watcher: {{use: "eyes:Watcher", channels: {{image: r/image}}}}
  b/watcher: {{use: "eyes:Watcher", channels: {{image: g/image}}}}
  a/follower: {{use: "eyes:Follower"}}
"""


@pytest.fixture
def eyes(tmp_path: Path, ports: PortBlock) -> Path:
    write_files(tmp_path, {**sources("eyes.py"), "eyes.yaml": LAUNCH.format(url=ports.public_url)})
    return tmp_path


def wants(eyes: Path, text: str) -> None:
    """Adds a line to the launch file."""
    with (eyes / "eyes.yaml").open("a") as file:
        file.write(f"{text}\n")


def record(launch: Launch, *options: str, log: str = "log.lcm") -> None:
    run = launch("eyes.yaml", "--ticks", "40", "--speed", "max", "--record", log, *options)
    assert run.wait() == 0, run.text


def test_replay_without_frames_skips_device_and_its_readers(launch: Launch, eyes: Path) -> None:
    record(launch)
    said = replayed(eyes)
    assert "not replayed: r/camera: 'the eye' is a device" in said
    assert "not replayed: a/watcher: it reads r/image, whose frames are not recorded" in said
    assert "equal: 120 messages" in said  # the grey camera, its viewer, and the follower
    assert "cannot be replayed: a/watcher" in fwk(eyes, "replay", "log.lcm", "--only", "a/watcher", code=2)
    assert "is a device" in fwk(eyes, "replay", "log.lcm", "--only", "r/camera", code=2)
    assert "equal" in replayed(eyes, "--only", "a/follower")
    assert (eyes / "opened").read_text() == "opened\n"


@pytest.mark.parametrize("hosting", ["process", "single"])
def test_readers_of_recorded_frames_replay_without_the_camera(launch: Launch, eyes: Path, hosting: str) -> None:
    wants(eyes, "record: {frames: [r, g/image]}")
    record(launch, "--hosting", hosting)
    said = replayed(eyes)
    assert said.count("not replayed") == 1
    assert "equal: 160 messages" in said
    assert "equal: 40 messages" in replayed(eyes, "--only", "a/watcher")
    assert "equal: 40 messages" in replayed(eyes, "--only", "b/watcher")
    assert (eyes / "opened").read_text() == "opened\n"
    text = (eyes / "eyes.py").read_text()
    assert "zlib.crc32(pixels.tobytes())" in text
    changed = text.replace("zlib.crc32(pixels.tobytes())", "zlib.crc32((pixels | 1).tobytes())")
    (eyes / "eyes.py").write_text(changed)
    said = replayed(eyes, "--only", "*/watcher", code=1)
    assert "different: 80 of 80 messages" in said
    assert "x_m" in said


def test_recorded_frames_are_whole_and_change_nothing_else(launch: Launch, eyes: Path, tmp_path: Path) -> None:
    without_device = "--without", "r/camera", "a/watcher"
    record(launch, *without_device, log="without.lcm")
    wants(eyes, "record: {frames: '*/image'}")
    record(launch, *without_device)
    assert difference(eyes / "log.lcm", eyes / "without.lcm") == ""
    pictures = list(pictures_in(eyes / "log.lcm"))
    assert [picture.frame for picture in pictures] == list(range(1, 41))
    assert {picture.camera for picture in pictures} == {"g/image"}
    fwk(eyes, "cam", "g/camera", "--log", "log.lcm", "--tick", "7", "--save", "seen.png")
    saved = cv2.imread(str(eyes / "seen.png"), cv2.IMREAD_UNCHANGED)
    assert saved is not None
    assert np.array_equal(saved, pictures[6].pixels())  # type: ignore[arg-type]
    assert "fwk/frame" in fwk(eyes, "log-info", "log.lcm")


def test_a_killed_reader_of_recorded_frames_replays(launch: Launch, eyes: Path, ports: PortBlock) -> None:
    wants(eyes, "record: {frames: r/image}\nclock: wall\nperiod_s: 0.02")
    run = Steered(launch("eyes.yaml", "--record", "log.lcm"), ports)
    run.ticks_pass(10)
    os.kill(run.component("a/watcher")["pid"], signal.SIGKILL)
    run.launched.until("a/watcher runs again, incarnation 2")
    run.ticks_pass(10)
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    assert "equal" in replayed(eyes)


def test_a_frame_missing_in_the_recording_is_named(launch: Launch, eyes: Path) -> None:
    wants(eyes, "record: {frames: r/image}")
    record(launch)
    data = (eyes / "log.lcm").read_bytes()
    frames = [event.data for event in LogReader(eyes / "log.lcm") if event.channel == FRAME]
    at = data.index(frames[39])  # the frame that is seen in tick 20
    (eyes / "log.lcm").write_bytes(data[: at + 8] + bytes(len(frames[39]) - 8) + data[at + len(frames[39]) :])
    said = replayed(eyes, "--only", "a/watcher", code=2)
    assert "frame 40 of r/image is not in the recording" in said
    assert "equal" in replayed(eyes, "--only", "a/watcher", "--to-tick", "19")


@pytest.mark.parametrize("clock", ["lockstep", "real time"])
def test_frames_lost_on_a_full_disk_are_reported(
    launch: Launch, eyes: Path, ports: PortBlock, small_disk: Callable[[int], Path], clock: str
) -> None:
    wants(eyes, "record: {frames: [r, g/image]}")
    wants(eyes, "speed: 4" if clock == "lockstep" else "clock: wall\nperiod_s: 0.02")
    log = small_disk(16) / "log.lcm"
    run = Steered(launch("eyes.yaml", "--record", str(log)), ports)
    run.launched.until_true(lambda: any(picture.tick > 5 for picture in pictures_in(log)), "pictures on the disk")
    big = fill(log.parent)
    run.launched.until("log.lcm: cannot record: No space left on device")
    run.ticks_pass(20)
    big.unlink()
    run.launched.until("log.lcm: the disk has room again; ")
    room_at = run.tick
    run.ticks_pass(20)
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    assert "messages are missing in the recording" in run.launched.text
    assert len({(picture.camera, picture.frame) for picture in pictures_in(log)}) == len(list(pictures_in(log)))
    assert max(picture.tick for picture in pictures_in(log)) > room_at
    told = replayed(eyes, log=log, code=2)
    said = re.search(r"messages are missing after tick (\d+).*replay the ticks before it", told)
    assert said, told
    assert int(said[1]) > 5
    assert "equal" in replayed(eyes, "--to-tick", said[1], log=log)


def test_recording_frames_of_an_unknown_camera_is_a_mistake(launch: Launch, eyes: Path) -> None:
    wants(eyes, "record: {frames: r/imgae}")
    said = fwk(eyes, "check", "eyes.yaml", code=2)
    assert "record: no camera publishes 'r/imgae'; did you mean 'r/image'?" in said
