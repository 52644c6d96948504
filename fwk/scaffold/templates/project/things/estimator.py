"""Smooths the readings of the distance sensor."""

from fwk import Component, Config, Field, Logger, Reads, Writes
from lcmtypes.thing import distance_t


class EstimatorConfig(Config):
    """Settings of the estimator."""

    gain: float = Field(0.1, ge=0.0, le=1.0)
    """Weight of a new reading: 0 keeps the old value, 1 takes the reading."""
    near_m: float = 1.0
    """Distance below which the object is near."""


class Estimator(Component):
    """Smooths the readings and warns when the object is near."""

    stage = "worldstate"

    config: EstimatorConfig
    log: Logger
    reading: Reads[distance_t]
    distance: Writes[distance_t]

    def init(self) -> None:
        self.near = False

    def loop(self) -> None:
        if not self.reading.refreshed:
            return
        reading, smooth = self.reading.value, self.distance.value
        gain = self.config.gain if self.distance.sequence else 1.0
        smooth.range_m += gain * (reading.range_m - smooth.range_m)
        self.distance.write()
        near = smooth.range_m < self.config.near_m
        if near and not self.near:
            self.log.warning(f"the object is {smooth.range_m:.2f} m away")
        self.near = near
