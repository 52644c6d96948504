"""Iterates at a rate of its own, independent of the main loop."""

from fwk import Component, Config, Writes
from lcmtypes.thing import thing_t


class ThingConfig(Config):
    """Settings of the component."""

    scale: float = 1.0
    """Factor of the value that is written."""


class Thing(Component):
    """Writes the number of its iterations, at a rate of its own."""

    rate_hz = 10.0

    config: ThingConfig
    thing: Writes[thing_t]

    def init(self) -> None:
        self.count = 0

    def loop(self) -> None:
        self.count += 1
        self.thing.value.value = self.config.scale * self.count
        self.thing.write()
