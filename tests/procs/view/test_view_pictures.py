"""Pictures on the bus: of which camera, how often, how large, and lossless on request."""

from typing import Any

import cv2
import numpy as np
import pytest

from fwk.recording.pictures import picture_of
from fwk.testing import Bench, MemorySystem
from lcmtypes.core import picture_t
from procs.simulation.camera import Camera
from procs.view.pictures import Pictures
from procs.vision.colours import Picture
from procs.vision.omni_ball import OmniBall
from tests.procs.vision.picture_parts import World

NOISE = np.random.default_rng(1).integers(0, 256, (60, 80, 3), np.uint8)


def bench(**settings: Any) -> Bench:
    return Bench(Pictures, name="world/pictures", namespaces=("cyan1", "cyan2"), **settings)


def decoded(picture: Any) -> Picture:
    return np.asarray(cv2.imdecode(np.frombuffer(picture.data, np.uint8), cv2.IMREAD_UNCHANGED))


def test_each_camera_has_its_own_rate_in_logical_time() -> None:
    pictures = bench(rate_hz=4.0)  # every fifth tick
    for tick in range(11):
        pictures.show("image", NOISE, "cyan1")
        if tick >= 3:
            pictures.show("image", NOISE, "cyan2")
        pictures.iterate()
    sent = [(picture.camera, picture.header.tick) for picture in pictures.port("pictures").sent]
    assert [tick for camera, tick in sent if camera == "cyan1/image"] == [1, 6, 11]
    assert [tick for camera, tick in sent if camera == "cyan2/image"] == [4, 9]


def test_every_frame_on_request_and_none_twice() -> None:
    pictures = bench(rate_hz=0.0)
    for _ in range(3):
        pictures.show("image", NOISE, "cyan1")
        pictures.iterate(2)
    assert [(each.frame, each.header.tick) for each in pictures.port("pictures").sent] == [(1, 1), (2, 3), (3, 5)]


@pytest.mark.parametrize("pixels", [NOISE, NOISE[:, :, 0]])
def test_png_is_exact(pixels: Picture) -> None:
    pictures = bench(format="png")
    pictures.show("image", pixels, "cyan1")
    pictures.iterate()
    (picture,) = pictures.port("pictures").sent
    assert (picture.height_px, picture.width_px, picture.channels) == (60, 80, 3 if pixels.ndim == 3 else 1)
    assert (decoded(picture) == pixels).all()


def test_jpeg_is_smaller_with_less_quality_and_looks_alike() -> None:
    smooth = cv2.GaussianBlur(NOISE, (0, 0), 8)
    sizes = []
    for quality in (20, 90):
        pictures = bench(quality=quality)
        pictures.show("image", smooth, "cyan1")
        pictures.iterate()
        (picture,) = pictures.port("pictures").sent
        assert picture.format == "jpeg"
        assert np.abs(decoded(picture).astype(int) - smooth).mean() < 5
        sizes.append(picture.n)
    assert sizes[0] < sizes[1] < smooth.size / 2


def test_large_pictures_are_scaled_down() -> None:
    pictures = bench(longest_px=40)
    pictures.show("image", NOISE, "cyan1")
    pictures.iterate()
    (picture,) = pictures.port("pictures").sent
    assert (picture.height_px, picture.width_px) == (30, 40) == decoded(picture).shape[:2]


@pytest.mark.parametrize("kind", ["jpeg", "png"])
@pytest.mark.parametrize("channels", [2, 5])
def test_frames_of_two_channels_are_sent_as_raw_bytes(channels: int, kind: str) -> None:
    """And those of five."""
    pixels = np.dstack([NOISE, NOISE])[:, :, :channels]
    pictures = bench(format=kind)
    pictures.show("image", pixels, "cyan1")
    pictures.iterate()
    (picture,) = pictures.port("pictures").sent
    made = picture_of(picture.encode())
    assert (picture.format, picture.n) == ("raw", pixels.size)
    assert made is not None
    assert np.array_equal(np.asarray(made.pixels()), pixels)


@pytest.mark.parametrize(
    ("shape", "size"), [((1, 3000, 3), (1, 100, 3)), ((3000, 8, 2), (100, 1, 2)), ((3000, 9, 5), (100, 1, 5))]
)
def test_narrow_frames_keep_at_least_one_row(shape: tuple[int, ...], size: tuple[int, ...]) -> None:
    """And at least one column."""
    pictures = bench(longest_px=100)
    pictures.show("image", np.zeros(shape, np.uint8), "cyan1")
    pictures.iterate()
    (picture,) = pictures.port("pictures").sent
    assert (picture.height_px, picture.width_px, picture.channels) == size


def test_lost_frame_gives_no_picture() -> None:
    pictures = bench()
    pictures.port("image", "cyan1").put(frame=7, width_px=80, height_px=60, channels=3)  # announced, not in the ring
    pictures.iterate()
    assert pictures.port("pictures").sent == []
    assert "frame 7 was overwritten before it was read" in pictures.logged[0].text


def test_one_component_serves_the_cameras_of_all_robots() -> None:
    run = MemorySystem(
        {
            "world/world": World,
            "cyan1/camera": Camera,
            "cyan1/omni_ball": OmniBall,
            "magenta2/camera": Camera,
            "world/pictures": Pictures,
        }
    )
    run.tick(2)
    assert [picture_t.decode(data).camera for data in run.sent["world/pictures"]] == ["cyan1/image", "magenta2/image"]
