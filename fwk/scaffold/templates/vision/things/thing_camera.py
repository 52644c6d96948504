"""A simulated camera, to be replaced by the driver of a real one."""

import numpy as np

from fwk import Component, Config, Field, VisionMaster

SQUARE_PX = 8


class ThingCameraConfig(Config):
    """Settings of the camera."""

    size_px: int = Field(64, ge=16, frozen=True)
    """Width and height of a frame."""


class ThingCamera(Component):
    """Shows a bright square that moves from left to right."""

    stage = "sensor_acquire"

    config: ThingCameraConfig
    thing_image: VisionMaster

    def init(self) -> None:
        self.left_px = 0

    def loop(self) -> None:
        size = self.config.size_px
        self.left_px = (self.left_px + 1) % (size - SQUARE_PX)
        pixels = np.zeros((size, size), np.uint8)
        pixels[size // 2 : size // 2 + SQUARE_PX, self.left_px : self.left_px + SQUARE_PX] = 255
        self.thing_image.publish(pixels)
