"""Driver of a real camera, or of recorded pictures: publishes the frames as the simulated camera does."""

from pathlib import Path
from typing import Literal

import cv2
import numpy as np
from pydantic import Field as Setting
from pydantic import PositiveFloat

from fwk import Clock, Component, Config, Logger, VisionMaster
from procs.drivers.live_pictures import Backoff, Live, Wanted, check_device, open_device, open_stream
from procs.drivers.recorded_pictures import Endless, Folder, Recorded, SourceError, Video
from procs.vision.colours import Picture
from procs.vision.framing import central_part, scaled


class CameraDriverConfig(Config):
    """Settings of the camera's driver."""

    source: str | int = "/dev/video0"
    """Device (`/dev/video0`, or its number), address (`rtsp://...`, `http://...`), video file, or folder of pictures,
    which are taken in the order of their names.
    """
    width_px: int = Setting(default=0, ge=0, le=10_000)
    """Width of the frames, also requested from a device; 0, with height_px: unchanged."""
    height_px: int = Setting(default=0, ge=0, le=10_000)
    """See width_px."""
    grey: bool = False
    """Frames of one channel (gray8) instead of three (bgr8)."""
    rate_hz: float = Setting(default=0.0, ge=0.0, le=1000.0)
    """Pictures per second requested from a device; 0: its own rate."""
    at_end: Literal["stop", "loop", "fail"] = "stop"
    """What happens after the last picture of a file or folder: `stop`: no more frames; `loop`: the pictures begin
    again; `fail`: the component fails."""
    retry_s: PositiveFloat = 0.5
    """Time until a lost device or stream is opened again; doubles with each failure."""
    longest_retry_s: PositiveFloat = 10.0
    """Longest time until a lost device or stream is opened again."""


class CameraDriver(Component):
    """Publishes a picture of its source in each iteration.

    A file or folder gives each tick its picture: picture k, from 0, belongs to tick 1 + k * `every`. A device or stream
    gives its newest picture, if there is a new one.
    """

    stage = "sensor_acquire"
    offset = 1
    image: VisionMaster
    config: CameraDriverConfig
    clock: Clock
    log: Logger

    @classmethod
    def unrepeatable(cls, config: CameraDriverConfig) -> str:
        source = str(config.source)
        if "://" in source:
            return f"'{source}' is a stream, whose pictures cannot be repeated"
        if _is_device(source):
            return f"'{source}' is a device, whose pictures cannot be repeated"
        return "" if Path(source).exists() else f"'{source}' does not exist any more"

    def init(self) -> None:
        """Opens the source.

        Raises:
            SourceError: it cannot be opened.
        """
        self._live: Live | None = None
        self._recorded: Recorded | None = None
        self._open()

    def loop(self) -> None:
        if self._live:
            for text in self._live.news():
                self.log.warning(f"{self.config.source} {text}")
        pixels = self._live.picture() if self._live else self._picture((self.clock.tick - 1) // self.clock.every)
        if pixels is not None:
            self.image.publish(self._as_wanted(pixels))

    def config_changed(self) -> None:
        self.finalize()
        try:
            self._open()
        except SourceError as error:
            self.log.error(f"{error}; no frames until the settings change")

    def finalize(self) -> None:
        if self._live:
            self._live.close()
        if self._recorded:
            self._recorded.close()

    def _open(self) -> None:
        """Opens the source of the settings.

        Raises:
            SourceError: the source cannot be opened, or only one of width and height is given.
        """
        config = self.config
        self._live, self._recorded, self._ended = None, None, False
        if bool(config.width_px) != bool(config.height_px):
            raise SourceError(f"{self.name}: width_px and height_px belong together; give both or none")
        source, path = str(config.source), Path(str(config.source))
        backoff = Backoff(config.retry_s, config.longest_retry_s)
        if "://" in source:
            self._live = Live(lambda: open_stream(source), backoff)
        elif path.is_file() or path.is_dir():
            self._recorded = Folder(path) if path.is_dir() else Video(path)
            self._recorded = Endless(self._recorded) if config.at_end == "loop" else self._recorded
        else:
            device = Path(f"/dev/video{source}") if source.isdecimal() else path
            wanted = Wanted(config.width_px, config.height_px, config.rate_hz)
            check_device(device)
            self._live = Live(lambda: open_device(device, wanted), backoff)

    def _picture(self, number: int) -> Picture | None:
        """Returns a recorded picture, or None after the last.

        Raises:
            SourceError: the picture is damaged, or the last one has been read and `at_end` is `fail`.
        """
        if self._ended or self._recorded is None:
            return None
        found = self._recorded.picture(number)
        if found is None:
            self._ended = True
            end = f"{self.config.source} has ended after picture {self._recorded.count}"
            if self.config.at_end == "fail":
                raise SourceError(end)
            self.log.info(f"{end}; no more frames")
        return found

    def _as_wanted(self, pixels: Picture) -> Picture:
        """Returns the picture with the colours and the size of the settings, cropped to their aspect."""
        config = self.config
        if config.grey:
            pixels = np.asarray(cv2.cvtColor(pixels, cv2.COLOR_BGR2GRAY), np.uint8)
        if config.width_px:
            part = central_part(pixels, config.width_px / config.height_px)
            return scaled(part, config.width_px, config.height_px)
        return pixels


def _is_device(source: str) -> bool:
    return source.isdecimal() or source.startswith("/dev/") or Path(source).is_char_device()
