"""One crane for all."""

from fwk import Clock, CommandsEach, Component, Future, Sends, Writes, channel
from lcmtypes.crane import haul_t, tally_t


class Crane(Component):
    stage = "act"
    clock: Clock
    hauls: CommandsEach[haul_t] = channel("*/haul")

    def loop(self) -> None:
        for hauls in self.hauls.values():
            for command in list(hauls.open):
                command.done()
            for command in hauls:
                command.accept()


class Robot(Component):
    stage = "think"
    haul: Sends[haul_t]
    tally: Writes[tally_t]

    def init(self) -> None:
        self.future: Future | None = None

    def loop(self) -> None:
        tally = self.tally.value
        if self.future and self.future.finished:
            tally.done += self.future.done
            tally.failed += not self.future.done
        if not self.future or self.future.finished:
            self.future = self.haul.send()
        self.tally.write()
