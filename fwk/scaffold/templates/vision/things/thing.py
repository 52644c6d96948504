"""Looks for something bright in the frames of a camera."""

import numpy as np

from fwk import Component, Config, Field, Image, Writes
from lcmtypes.thing import thing_t


class ThingConfig(Config):
    """Settings of the component."""

    bright: int = Field(128, ge=0, le=255)
    """Value from which a pixel is bright."""


class Thing(Component):
    """Finds the centre of the bright pixels in each frame."""

    stage = "sensor_process"

    config: ThingConfig
    thing_image: Image
    thing: Writes[thing_t]

    def loop(self) -> None:
        pixels = self.thing_image.pixels if self.thing_image.changed else None
        if pixels is None:
            return
        rows, columns = np.nonzero(pixels >= self.config.bright)
        seen = self.thing.value
        seen.found = bool(rows.size)
        seen.x_px, seen.y_px = (float(columns.mean()), float(rows.mean())) if seen.found else (0.0, 0.0)
        self.thing.write()
