"""A counter that fails at the number that its settings give."""

from fwk import Component, Config, Writes
from lcmtypes.cards import count_t


class CounterConfig(Config):
    last: int = 1_000_000
    """Fails above this."""


class Counter(Component):
    """Writes the number of its iterations."""

    stage = "think"
    config: CounterConfig
    count: Writes[count_t]

    def loop(self) -> None:
        self.count.value.number += 1
        if self.count.value.number > self.config.last:
            raise RuntimeError("counted too far")
        self.count.write()
