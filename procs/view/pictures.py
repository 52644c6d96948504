"""Publishes compressed frames of all cameras on the bus, for recordings and for viewers on other machines."""

from typing import Literal

import cv2
import numpy as np
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Each, Image, Writes
from lcmtypes.core import picture_t
from procs.model.units import US_PER_S
from procs.vision.colours import Picture


class PicturesConfig(Config):
    """Settings of the pictures on the bus."""

    rate_hz: float = Setting(default=2.0, ge=0.0)
    """Most pictures of each camera per second of logical time; 0: every frame."""
    format: Literal["jpeg", "png"] = "jpeg"
    """jpeg is small and lossy; png is lossless and large."""
    quality: int = Setting(default=80, ge=1, le=100)
    """Quality of a jpeg picture; 100 is best."""
    longest_px: int = Setting(default=0, ge=0)
    """Larger pictures are scaled down until their longer side has this length; 0: no picture is scaled."""


class Pictures(Component):
    """Runs after all other stages of the tick, so that no component waits for a picture."""

    stage = "post_loop"

    image: Each[Image]
    pictures: Writes[picture_t]
    config: PicturesConfig
    clock: Clock

    def init(self) -> None:
        cv2.setNumThreads(1)
        self._taken_us: dict[str, int] = {}

    def loop(self) -> None:
        for namespace, image in self.image.items():
            if image.changed and self._is_due(namespace):
                pixels = image.pixels
                if pixels is not None:
                    self._taken_us[namespace] = self.clock.now_us
                    self._write(image.announcement.channel, image.announcement.value.frame, pixels)

    def _is_due(self, namespace: str) -> bool:
        before_us = self._taken_us.get(namespace)
        if before_us is None or not self.config.rate_hz:
            return True
        return self.clock.now_us - before_us >= US_PER_S / self.config.rate_hz

    def _write(self, camera: str, frame: int, pixels: Picture) -> None:
        config, picture = self.config, self.pictures.value
        longer_px = max(pixels.shape[:2])
        if 0 < config.longest_px < longer_px:
            factor = config.longest_px / longer_px
            smaller = cv2.resize(pixels, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
            pixels = np.asarray(smaller, np.uint8)
        how = (
            [cv2.IMWRITE_JPEG_QUALITY, config.quality] if config.format == "jpeg" else [cv2.IMWRITE_PNG_COMPRESSION, 1]
        )
        _, data = cv2.imencode(f".{config.format}", pixels, how)
        picture.camera, picture.frame, picture.format = camera, frame, config.format
        picture.height_px, picture.width_px, picture.channels = (*pixels.shape, 1)[:3]
        picture.data = data.tobytes()
        self.pictures.write()
