"""Provides an aspect, and shows how another component uses it."""

from fwk import Aspect, Component, Config, Logger, Reads, Writes
from lcmtypes.thing import thing_t


class Level(Aspect):
    """Object given to components that declare `level: Level`."""

    thing: Reads[thing_t]

    def low(self) -> bool:
        """Returns whether the level is known and below a quarter."""
        return self.thing.has_value and self.thing.value.value < 0.25


class ThingConfig(Config):
    """Settings of the provider."""

    loss: float = 0.01
    """Decrease of the level in each iteration."""


class Thing(Component):
    """Measures a level and provides it as the aspect `Level`."""

    stage = "sensor_acquire"
    provides = Level

    config: ThingConfig
    thing: Writes[thing_t]

    def init(self) -> None:
        self.thing.value.value = 1.0

    def loop(self) -> None:
        measured = self.thing.value
        measured.value = max(0.0, measured.value - self.config.loss)
        self.thing.write()


class ThingUser(Component):
    """Logs when the level becomes low."""

    stage = "think"

    log: Logger
    level: Level

    def init(self) -> None:
        self.low = False

    def loop(self) -> None:
        low = self.level.low()
        if low and not self.low:
            self.log.warning("the level is low")
        self.low = low
