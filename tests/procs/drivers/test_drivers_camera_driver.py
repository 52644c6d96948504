"""The camera driver: pictures of files by tick, interrupted streams, and devices that do not exist."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fwk.clock import monotonic_us, sleep_s
from fwk.testing import Bench, MemorySystem
from procs.drivers.camera_driver import CameraDriver, CameraDriverConfig
from procs.drivers.recorded_pictures import SourceError
from procs.vision.colours import Picture
from procs.vision.omni_ball import OmniBall
from procs.vision.omni_field import OmniField
from tests.procs.vision.picture_parts import Stream, shades, simulated, write_folder, write_video

TIMEOUT_US = 60_000_000


def bench(source: Path | str, **settings: Any) -> Bench:
    return Bench(CameraDriver, name="cyan1/camera", source=str(source), **settings)


def seen(camera: Bench) -> Picture | None:
    """Returns the picture that the next iteration publishes."""
    before = len(camera.port("image").sent)
    camera.iterate()
    sent = camera.port("image").sent[before:]
    if not sent:
        return None
    (frame,) = sent
    flat = camera.component.image._ring.get(frame.frame, frame.height_px * frame.width_px * frame.channels)
    return np.asarray(flat.reshape(frame.height_px, frame.width_px, frame.channels))


def shades_of(camera: Bench, ticks: int) -> list[int | None]:
    """Returns which of `shades` each of the next pictures is."""
    pictures = [seen(camera) for _ in range(ticks)]
    return [None if each is None else round(float(each.mean()) / 8) for each in pictures]


@pytest.fixture(params=["folder", "film.mp4", "film.avi"])
def film(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """Twelve pictures, each lighter than the one before."""
    path = tmp_path / request.param
    return write_video(path, shades(12)) if path.suffix else write_folder(path, shades(12))


def test_picture_k_comes_in_tick_k(film: Path) -> None:
    assert shades_of(bench(film), 12) == list(range(12))


def test_source_ends_with_one_log_line(film: Path) -> None:
    camera = bench(film)
    assert shades_of(camera, 15)[10:] == [10, 11, None, None, None]
    assert [line.text for line in camera.logged] == [f"{film} has ended after picture 12; no more frames"]


def test_source_begins_again_on_request(film: Path) -> None:
    assert shades_of(bench(film, at_end="loop"), 27)[10:] == [10, 11, *range(12), 0, 1, 2]


def test_source_fails_at_its_end_on_request(film: Path) -> None:
    camera = bench(film, at_end="fail")
    camera.iterate(12)
    with pytest.raises(SourceError, match="has ended after picture 12"):
        camera.iterate()


@pytest.mark.parametrize(("at_end", "expected"), [("stop", 7), ("loop", 7)])
def test_late_start_gives_the_picture_of_the_tick(film: Path, at_end: str, expected: int) -> None:
    camera = bench(film, at_end=at_end)
    camera.tick = 7
    assert shades_of(camera, 1) == [expected]
    looping = bench(film, at_end="loop")
    looping.tick = 31
    assert shades_of(looping, 2) == [7, 8]


def test_every_third_tick(film: Path) -> None:
    assert shades_of(bench(film, every=3), 7) == [0, None, None, 1, None, None, 2]


def test_size_and_channels_follow_the_settings(film: Path) -> None:
    camera = bench(film, width_px=32, height_px=24, grey=True)
    camera.iterate(3)
    frame = camera.port("image").sent[-1]
    assert (frame.width_px, frame.height_px, frame.channels, frame.encoding) == (32, 24, 1, "gray8")


@pytest.mark.parametrize(("width_px", "height_px"), [(1, 1000), (1000, 1)])
def test_frame_may_be_as_narrow_as_a_pixel(film: Path, width_px: int, height_px: int) -> None:
    camera = bench(film, width_px=width_px, height_px=height_px)
    camera.iterate()
    frame = camera.port("image").sent[-1]
    assert (frame.width_px, frame.height_px) == (width_px, height_px)


def test_new_source_during_a_run_begins_at_the_tick(film: Path, tmp_path: Path) -> None:
    camera = bench(film)
    assert shades_of(camera, 3) == [0, 1, 2]
    write_folder(tmp_path / "other", shades(20)[10:])
    camera.component.config.source = str(tmp_path / "other")
    camera.component.config_changed()
    assert shades_of(camera, 2) == [13, 14]
    camera.component.config.source = str(tmp_path / "none")
    camera.component.config_changed()
    assert shades_of(camera, 2) == [None, None]
    assert "no frames until the settings change" in camera.logged[-1].text


@pytest.mark.parametrize(
    ("source", "error"),
    [
        ("/dev/video99", r"'/dev/video99': No such file or directory; video devices of this machine: .+"),
        ("99", r"'/dev/video99': No such file or directory"),
        ("/dev/nothing.mp4", r"'/dev/nothing.mp4': No such file or directory"),
        ("/dev/null", r"'/dev/null': it gives no pictures; does another program use it, or is it not a camera\?"),
        ("http://127.0.0.1:9/x.mjpeg", r"no pictures arrive from it; is the camera running"),
        ("{folder}", r"no pictures in this folder; they end in \.bmp, "),
        ("{folder}/text.mp4", r"not a readable video"),
    ],
)
def test_source_that_cannot_be_opened_is_refused_with_a_reason(tmp_path: Path, source: str, error: str) -> None:
    (tmp_path / "text.mp4").write_text("no film" * 100)
    with pytest.raises(SourceError, match=error):
        bench(source.format(folder=tmp_path))


def test_device_may_be_named_by_its_number() -> None:
    with pytest.raises(SourceError, match="'/dev/video99'"):
        Bench(CameraDriver, name="cyan1/camera", source=99)


def test_unreadable_device_is_refused_with_its_group(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("os.access", lambda *_: False)  # root may read everything
    with pytest.raises(SourceError, match="on most systems users have to be in the group 'video'"):
        bench("/dev/null")


def test_half_a_size_is_refused(film: Path) -> None:
    with pytest.raises(SourceError, match="cyan1/camera: width_px and height_px belong together"):
        bench(film, width_px=640)


def test_damaged_picture_is_named(tmp_path: Path) -> None:
    folder = write_folder(tmp_path / "film", shades(3))
    (folder / "frame1.png").write_text("nothing")
    camera = bench(folder)
    camera.iterate()
    with pytest.raises(SourceError, match=r"frame1\.png': not a readable picture"):
        camera.iterate()


def test_folder_may_hold_more_than_pictures(tmp_path: Path) -> None:
    folder = write_folder(tmp_path / "film", shades(3))
    (folder / "frame1.png").rename(folder / "²1.png")
    (folder / "._frame0.png").write_text("notes of a file system")
    (folder / "frame00.png").mkdir()
    assert shades_of(bench(folder), 4) == [0, 2, 1, None]


@pytest.fixture
def streams() -> Iterator[Callable[..., Stream]]:
    """Creates network cameras."""
    made: list[Stream] = []

    def start(shade: int, port: int = 0) -> Stream:
        made.append(Stream(np.full((48, 64, 3), shade, np.uint8), port))
        return made[-1]

    yield start
    for stream in made:
        stream.end()


def until(camera: Bench, happened: Callable[[], bool]) -> None:
    """Iterates until `happened` is true."""
    deadline_us = monotonic_us() + TIMEOUT_US
    while not happened():
        assert monotonic_us() < deadline_us, [line.text for line in camera.logged]
        camera.iterate()
        sleep_s(0.005)


def test_lost_stream_is_reported_reopened_and_continued(streams: Callable[..., Stream]) -> None:
    stream = streams(100)
    camera = bench(stream.url, retry_s=0.05, longest_retry_s=0.1)
    frames, logged = camera.port("image").sent, camera.logged
    until(camera, lambda: len(frames) >= 3)
    stream.end()
    until(camera, lambda: len(logged) >= 2)
    before = len(frames)
    assert f"{stream.url} lost: it gives no more pictures" in logged[0].text
    assert f"{stream.url} not back: '{stream.url}': no pictures arrive from it" in logged[1].text
    streams(200, stream.port)
    until(camera, lambda: len(frames) >= before + 3)
    assert [line.text for line in logged[2:]] == [f"{stream.url} back"]  # reported once, not at each attempt
    picture = None
    while picture is None:
        picture = seen(camera)
    assert round(float(picture.mean())) == pytest.approx(200, abs=2)
    camera.component.finalize()


def test_detectors_see_the_same_in_saved_frames(tmp_path: Path) -> None:
    pictures, live = simulated(6)
    folder = write_folder(tmp_path / "film", pictures)
    replayed = MemorySystem(
        {"cyan1/camera": CameraDriver, "cyan1/omni_ball": OmniBall, "cyan1/omni_field": OmniField},
        settings={"cyan1/camera": {"source": str(folder)}},
    )
    replayed.tick(8)
    for channel in ("cyan1/ball_percept", "cyan1/line_points", "cyan1/obstacle_percepts"):
        assert replayed.sent[channel] == live.sent[channel]


@pytest.mark.parametrize(
    ("source", "reason"),
    [
        ("/dev/video0", "is a device"),
        (2, "is a device"),
        ("rtsp://10.0.0.7/", "is a stream"),
        ("film-that-is-gone.mp4", "does not exist any more"),
        (__file__, ""),
    ],
)
def test_live_source_warns_that_a_replay_cannot_read_it(source: str | int, reason: str) -> None:
    said = CameraDriver.unrepeatable(CameraDriverConfig.model_validate({"source": source}))
    assert reason in said
    assert bool(said) == bool(reason)


def test_link_to_a_device_is_a_device(tmp_path: Path) -> None:
    link = tmp_path / "camera"
    link.symlink_to("/dev/zero")
    assert "is a device" in CameraDriver.unrepeatable(CameraDriverConfig(source=str(link)))
