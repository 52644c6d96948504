"""`fwk cam` on recordings, and pictures in a terminal."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.cli.look.picture_output import as_text
from fwk.lcm.event_log import LogWriter
from lcmtypes.core import picture_t

NOISE = np.random.default_rng(1).integers(0, 256, (60, 80, 3), np.uint8)


@pytest.fixture
def log(tmp_path: Path) -> Path:
    """A log with three pictures of one camera, one of another, and other messages."""
    with LogWriter(tmp_path / "log.lcm", print) as writer:
        for tick, camera in enumerate(("cyan1/image", "cyan1/image", "cyan2/front", "cyan1/image"), 1):
            picture = picture_t()
            picture.header.tick, picture.header.time_us = tick, 50_000 * tick
            picture.camera, picture.frame, picture.format = camera, tick, "png"
            picture.data = cv2.imencode(".png", NOISE // tick)[1].tobytes()
            picture.n = len(picture.data)
            writer.append("world/pictures", picture.encode(), 50_000 * tick)
            writer.append("cyan1/other", b"12345678", 50_000 * tick)
    return tmp_path / "log.lcm"


def cam(*arguments: str | Path, code: int = 0) -> str:
    done = CliRunner().invoke(app, ["cam", *map(str, arguments)])
    assert done.exit_code == code, done.output
    return done.output


def test_cameras_of_a_recording_are_listed(log: Path) -> None:
    assert cam("--log", log).splitlines() == [
        "cyan1/image          3 pictures (png), the last of tick 4",
        "cyan2/front          1 pictures (png), the last of tick 3",
    ]
    assert json.loads(cam("--log", log.parent, "--json"))[0] == {
        "channel": "cyan1/image",
        "pictures": 3,
        "format": "png",
        "tick": 4,
    }


@pytest.mark.parametrize(("arguments", "tick"), [((), 4), (("--tick", "3"), 2)])
def test_the_newest_picture_as_of_a_tick_is_saved(log: Path, arguments: tuple[str, ...], tick: int) -> None:
    file = log.parent / "new" / "one.png"
    said = cam("cyan1/image", "--log", log, "--save", file, *arguments)
    assert f"cyan1/image, frame {tick}, tick {tick}, {0.05 * tick:.3f} s, 60 x 80 x 3" in said
    assert np.array_equal(np.asarray(cv2.imread(str(file)), np.uint8), NOISE // tick)


def test_saved_frames_can_be_read_by_the_camera_driver(log: Path) -> None:
    assert cam("cyan1/image", "--log", log, "--save", log.parent / "all").endswith("all: 3 pictures\n")
    names = sorted(file.name for file in (log.parent / "all").iterdir())
    assert names == ["frame000001.png", "frame000002.png", "frame000004.png"]


def test_recorded_frames_count_instead_of_sent_pictures(tmp_path: Path) -> None:
    first, second = (("world/pictures", 1), ("fwk/frame", 1)), (("fwk/frame", 2), ("world/pictures", 2))
    with LogWriter(tmp_path / "log.lcm", print) as writer:
        for channel, frame in (*first, *second):
            data = cv2.imencode(".png", NOISE if channel == "fwk/frame" else NOISE // 2)[1].tobytes()
            picture = picture_t(camera="cyan1/image", frame=frame, format="png", data=data, n=len(data))
            writer.append(channel, picture.encode(), 0)
    words, all_of_it = ("--log", tmp_path / "log.lcm"), tmp_path / "all"
    assert "cyan1/image          2 pictures (png)" in cam(*words)
    assert cam("cyan1/image", *words, "--save", all_of_it).endswith("all: 2 pictures\n")
    saved = [np.asarray(cv2.imread(str(file)), np.uint8) for file in all_of_it.iterdir()]
    assert [np.array_equal(each, NOISE) for each in saved] == [True, True]


def test_raw_bytes_are_those_of_the_frame(log: Path) -> None:
    cam("cyan2/front", "--log", log, "--save", log.parent / "one.bin", "--raw")
    assert (log.parent / "one.bin").read_bytes() == (NOISE // 3).tobytes()


@pytest.mark.parametrize("channels", [2, 5])
def test_frames_that_no_picture_file_holds_are_saved_raw(tmp_path: Path, channels: int) -> None:
    pixels = np.dstack([NOISE, NOISE])[:, :, :channels]
    picture = picture_t(camera="cyan1/depth", format="raw", data=pixels.tobytes(), n=pixels.size)
    picture.height_px, picture.width_px, picture.channels = pixels.shape
    with LogWriter(tmp_path / "log.lcm", print) as writer:
        writer.append("world/pictures", picture.encode(), 0)
    words = ("cyan1/depth", "--log", tmp_path / "log.lcm", "--save")
    said = cam(*words, tmp_path / "one.png", code=2)
    assert f"no picture file has {channels} channels; --raw saves the bytes" in said
    cam(*words, tmp_path / "one.bin", "--raw")
    assert (tmp_path / "one.bin").read_bytes() == pixels.tobytes()
    assert as_text(pixels, 40, 20) == as_text(np.ascontiguousarray(pixels[:, :, 0]), 40, 20)


@pytest.mark.parametrize(
    ("arguments", "error"),
    [
        (("cyan1/imag", "--log", "{log}", "--save", "{log}.png"), "did you mean 'cyan1/image'?"),
        (("cyan3/image", "--log", "{log}", "--save", "{log}.png"), "no pictures of 'cyan3/image'"),
        (
            ("cyan1/image", "--log", "{log}", "--save", "{log}.tga"),
            "the name has no suffix of a picture; use one of .bmp, ",
        ),
        (("cyan1/image", "--log", "{log}"), "a picture is shown only in a terminal"),
        (("--log", "none.lcm"), "none.lcm: cannot read"),
        (("--raw",), "--raw is an option of --save"),
        (("--tick", "3"), "--tick is for recordings"),
    ],
)
def test_impossible_requests_are_explained(log: Path, arguments: tuple[str, ...], error: str) -> None:
    said = cam(*(each.format(log=log) for each in arguments), code=2)
    assert error in " ".join(said.replace("│", " ").split())


def test_a_recording_without_pictures_says_how_to_get_some(tmp_path: Path) -> None:
    LogWriter(tmp_path / "log.lcm", print).close()
    assert "no pictures; 'record: {frames: ...}' in the launch file" in cam("--log", tmp_path / "log.lcm", code=1)


@pytest.mark.parametrize(("columns", "rows", "expected"), [(40, 40, (40, 15)), (200, 10, (27, 10)), (80, 30, (80, 30))])
def test_a_picture_fits_the_terminal_and_keeps_its_proportions(
    columns: int, rows: int, expected: tuple[int, int]
) -> None:
    lines = as_text(NOISE, columns, rows).plain.splitlines()
    assert (len(lines[0]), len(lines)) == expected
    assert {len(line) for line in lines} == {expected[0]}


def test_each_character_has_the_colours_of_two_pixels() -> None:
    pixels = np.array([[[255, 0, 0]], [[0, 0, 255]]], np.uint8)  # blue over red
    (span,) = as_text(pixels, 1, 1).spans
    assert str(span.style) == "#0000ff on #ff0000"
