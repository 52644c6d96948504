"""A camera and a viewer of its frames."""

import zlib

import numpy as np

from fwk import Component, Image, VisionMaster, Writes
from lcmtypes.play import look_t


class Camera(Component):
    """Publishes one to three frames of noise in each iteration."""

    stage = "sensor_acquire"

    rng: np.random.Generator
    image: VisionMaster

    def loop(self) -> None:
        for _ in range(self.rng.integers(1, 4)):
            self.image.publish(self.rng.integers(256, size=(48, 64, 3), dtype=np.uint8))


class Viewer(Component):
    """Looks at the newest frame."""

    stage = "sensor_process"

    image: Image
    look: Writes[look_t]

    def loop(self) -> None:
        pixels = self.image.pixels
        self.look.value.frame = self.image.announcement.value.frame
        self.look.value.digest = -1 if pixels is None else zlib.crc32(pixels.tobytes())
        self.look.value.lost = self.image.lost
        self.look.write()
