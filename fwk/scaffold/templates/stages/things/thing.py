"""Counts up."""

from fwk import Component, Config, Logger, Writes
from lcmtypes.thing import thing_t


class ThingConfig(Config):
    """Settings of the component."""

    step: float = 1.0
    """Number that is added in each iteration."""


class Thing(Component):
    """Counts up by a step in each iteration."""

    stage = "think"

    config: ThingConfig
    log: Logger
    thing: Writes[thing_t]

    def init(self) -> None:
        self.log.info(f"counting in steps of {self.config.step:g}")

    def loop(self) -> None:
        self.thing.value.value += self.config.step
        self.thing.write()
