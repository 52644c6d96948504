"""What detectors in the omnidirectional camera's picture have in common."""

from abc import ABC, abstractmethod

from fwk import Component, Config, Image
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import Picture


class DetectorConfig(Config):
    """Settings of every detector."""

    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the camera."""


class Detector(Component, ABC):
    """Looks at every frame of its robot's camera once."""

    stage = "sensor_prepare"
    image: Image
    config: DetectorConfig

    def init(self) -> None:
        self.apply_settings()

    def config_changed(self) -> None:
        self.apply_settings()

    def loop(self) -> None:
        if not self.image.changed:
            return
        pixels = self.image.pixels
        if pixels is None:
            self.report_nothing()
            return
        self.config.mirror.check_frame(pixels, self.name)
        self.detect(pixels)

    @abstractmethod
    def apply_settings(self) -> None:
        """Makes what depends on the settings alone."""

    @abstractmethod
    def detect(self, pixels: Picture) -> None:
        """Finds what there is in a frame and writes it."""

    @abstractmethod
    def report_nothing(self) -> None:
        """Writes that nothing was seen: the frame is lost."""
