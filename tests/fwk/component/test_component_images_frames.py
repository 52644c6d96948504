"""Invalid frames are refused where they are published."""

from typing import Any

import numpy as np
import pytest

from fwk import Component, VisionMaster
from fwk.component.images import SLOTS, FrameError, Ring
from fwk.testing import Bench


class Camera(Component):
    stage = "sensor_acquire"
    image: VisionMaster


@pytest.mark.parametrize(
    ("pixels", "shape"),
    [
        (np.zeros((2, 2)), r"float64 \(2, 2\)"),
        (np.zeros((2, 2, 3, 1), np.uint8), r"uint8 \(2, 2, 3, 1\)"),
        (np.zeros((0, 3), np.uint8), r"uint8 \(0, 3\)"),
        (np.broadcast_to(np.uint8(0), (3000, 3000)), r"uint8 \(3000, 3000\)"),
    ],
)
def test_invalid_frames_are_refused(pixels: Any, shape: str) -> None:
    bench = Bench(Camera)
    with pytest.raises(
        FrameError, match=f"robot/image: a frame is a uint8 array, .* of at most 8388608 bytes, not {shape}"
    ):
        bench.component.image.publish(pixels)
    bench.iterate()
    assert bench.port("image").sent == []


def test_ring_holds_no_more_frames_than_readers_could_see() -> None:
    bench = Bench(Camera)
    for _ in range(SLOTS - 1):
        bench.component.image.publish(np.zeros((2, 2), np.uint8))
    with pytest.raises(FrameError, match=f"robot/image: at most {SLOTS - 1} frames in one iteration"):
        bench.component.image.publish(np.zeros((2, 2), np.uint8))


def test_readers_without_announcements_find_a_frame_by_number() -> None:
    ring = Ring.create("a/image")
    assert ring.newest() is None
    for number in range(1, 7):
        ring.put(number, np.full((2, 3), number, np.uint8))
    found = {wanted: ring.newest(wanted) for wanted in (0, 2, 4)}
    assert {wanted: each[0] for wanted, each in found.items() if each} == {0: 6, 2: 6, 4: 4}
    assert found[4] is not None
    assert found[4][1].tolist() == [[4] * 3] * 2
