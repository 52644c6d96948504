"""A camera whose frames carry a checksum, and finders that check it."""

import zlib
from pathlib import Path

import numpy as np

from fwk import Clock, Component, Config, Image, VisionMaster, Writes, channel
from fwk.clock import sleep_s
from lcmtypes.soccer import pose_t


def leave(name: str, number: int) -> None:
    Path(f"{name}.new").write_text(str(number))
    Path(f"{name}.new").rename(name)


class Camera(Component):
    stage = "sensor_acquire"
    reaches_outside = False
    image: VisionMaster
    clock: Clock
    rng: np.random.Generator

    def loop(self) -> None:
        for _ in range(1 + self.clock.tick % 3):
            body = self.rng.integers(0, 256, 399_996, np.uint8)
            head = np.frombuffer(zlib.crc32(body.tobytes()).to_bytes(4, "big"), np.uint8)
            self.image.publish(np.concatenate([head, body]).reshape(400, 1000))
        leave("camera.frame", self.image._announcement.sequence + len(self.image._announcement._pending))


class FinderConfig(Config):
    dawdle_tick: int = 0
    """From this tick on, once, it reads its frame only after the camera has overwritten it."""


class Finder(Component):
    """Reports which frame it saw and whether the frame was whole."""

    stage = "sensor_prepare"
    reaches_outside = False
    image: Image = channel("r/image")
    pose: Writes[pose_t]
    clock: Clock
    config: FinderConfig

    def init(self) -> None:
        self.dawdled = False

    def loop(self) -> None:
        if self.clock.tick >= self.config.dawdle_tick > 0 and not self.dawdled:
            self.dawdled = True
            while int(Path("camera.frame").read_text()) < self.image.announcement.value.frame + 5:
                sleep_s(0.01)
        pixels = self.image.pixels
        self.pose.value.x_m = float(self.image.announcement.value.frame)
        if pixels is None:
            self.pose.value.y_m = -1.0
        else:
            flat = pixels.reshape(-1)
            self.pose.value.y_m = float(zlib.crc32(flat[4:].tobytes()) == int.from_bytes(flat[:4].tobytes(), "big"))
        self.pose.write()
