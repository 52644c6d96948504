"""Publishes compressed frames of all cameras on the bus, for recordings and for viewers on other machines."""

from typing import Literal

import cv2
import numpy as np
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Each, Image, Writes
from lcmtypes.core import picture_t
from procs.model.units import US_PER_S
from procs.vision.colours import Picture

_CHANNELS = (1, 3, 4)
"""Numbers of channels that jpeg and png support."""


class PicturesConfig(Config):
    """Settings of the pictures on the bus."""

    rate_hz: float = Setting(default=2.0, ge=0.0)
    """Most pictures of each camera per second of logical time; 0: every frame."""
    format: Literal["jpeg", "png"] = "jpeg"
    """jpeg is small and lossy; png is lossless and large. Frames of 2, or over 4, channels are sent as raw bytes."""
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
            height_px, width_px = (max(1, round(each * config.longest_px / longer_px)) for each in pixels.shape[:2])
            pixels = _scaled(pixels, width_px, height_px)
        picture.camera, picture.frame = camera, frame
        picture.height_px, picture.width_px, picture.channels = (*pixels.shape, 1)[:3]
        picture.format, picture.data = self._encoded(pixels)
        self.pictures.write()

    def _encoded(self, pixels: Picture) -> tuple[str, bytes]:
        """Returns format and bytes."""
        config = self.config
        if pixels.ndim == 3 and pixels.shape[2] not in _CHANNELS:
            return "raw", pixels.tobytes()
        how = (
            [cv2.IMWRITE_JPEG_QUALITY, config.quality] if config.format == "jpeg" else [cv2.IMWRITE_PNG_COMPRESSION, 1]
        )
        return config.format, cv2.imencode(f".{config.format}", pixels, how)[1].tobytes()


def _scaled(pixels: Picture, width_px: int, height_px: int) -> Picture:
    parts = cv2.split(pixels) if pixels.ndim == 3 and pixels.shape[2] > max(_CHANNELS) else [pixels]
    smaller = [cv2.resize(each, (width_px, height_px), interpolation=cv2.INTER_AREA) for each in parts]
    return np.asarray(np.dstack(smaller), np.uint8)
