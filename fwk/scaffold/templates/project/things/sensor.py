"""A simulated distance sensor: an object comes closer, and readings are noisy."""

import numpy as np

from fwk import Clock, Component, Config, Writes
from lcmtypes.thing import distance_t


class SensorConfig(Config):
    """Settings of the sensor."""

    speed_m_s: float = 0.5
    """Speed at which the object comes closer."""
    noise_m: float = 0.05
    """Standard deviation of a reading."""


class Sensor(Component):
    """Measures the distance of an object that comes closer."""

    stage = "sensor_acquire"

    config: SensorConfig
    clock: Clock
    rng: np.random.Generator
    reading: Writes[distance_t]

    def init(self) -> None:
        self.range_m = 10.0

    def loop(self) -> None:
        self.range_m = max(0.0, self.range_m - self.config.speed_m_s * self.clock.period_s)
        self.reading.value.range_m = self.rng.normal(self.range_m, self.config.noise_m)
        self.reading.write()
