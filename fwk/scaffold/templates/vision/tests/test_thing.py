"""The component finds what is bright in a frame."""

import numpy as np

from fwk.testing import Bench
from things.thing import Thing
from things.thing_camera import ThingCamera


def test_thing_finds_the_centre_of_what_is_bright() -> None:
    bench = Bench(Thing)
    pixels = np.zeros((32, 32), np.uint8)
    pixels[10:13, 20:23] = 200
    bench.show("thing_image", pixels)
    bench.iterate()
    seen = bench.thing.sent[-1]
    assert (seen.found, seen.x_px, seen.y_px) == (True, 21.0, 11.0)


def test_thing_finds_nothing_in_the_dark() -> None:
    bench = Bench(Thing)
    bench.show("thing_image", np.zeros((32, 32), np.uint8))
    bench.iterate()
    assert not bench.thing.sent[-1].found


def test_thing_camera_publishes_a_frame_in_each_iteration() -> None:
    bench = Bench(ThingCamera, size_px=32)
    bench.iterate(2)
    frames = bench.thing_image.sent
    assert [(frame.width_px, frame.height_px) for frame in frames] == [(32, 32), (32, 32)]
