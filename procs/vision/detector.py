"""Base of the detectors that work on the omnidirectional camera's frames."""

from abc import ABC, abstractmethod

from pydantic import Field

from fwk import Component, Config, Image
from procs.model.realism import Realism
from procs.vision.calibration import MirrorConfig
from procs.vision.colours import Picture
from procs.vision.exposure import captured_us


class DetectorConfig(Config):
    """Settings of every detector."""

    mirror: MirrorConfig = MirrorConfig()
    """Calibration of the camera."""
    realism: Realism = "realistic"
    """Errors of the camera that covariances allow for: none, friendly, realistic or harsh."""
    latency_s: float = Field(default=0.0, ge=0.0, le=1.0)
    """Time from the exposure of a frame until its camera publishes it, for cameras that do not state the exposure."""


class Detector(Component, ABC):
    """Handles every frame of its robot's camera once."""

    stage = "sensor_prepare"
    image: Image
    config: DetectorConfig

    def init(self) -> None:
        self.apply_settings()

    def config_changed(self) -> None:
        self.apply_settings()

    @property
    def capture_us(self) -> int:
        """Logical time of the newest frame's exposure; 0 if it is not known."""
        return captured_us(self.image, self.config.latency_s)

    def loop(self) -> None:
        if not self.image.changed:
            return
        pixels = self.image.pixels
        if pixels is None:
            self.report_nothing()
            return
        self.detect(self.config.mirror.fitted(pixels))

    @abstractmethod
    def apply_settings(self) -> None:
        """Builds everything that depends on the settings alone."""

    @abstractmethod
    def detect(self, pixels: Picture) -> None:
        """Writes the findings of a frame."""

    @abstractmethod
    def report_nothing(self) -> None:
        """Writes empty findings for a lost frame."""
