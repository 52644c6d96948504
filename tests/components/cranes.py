"""One crane that serves all clients."""

from fwk import Call, Calls, Clock, Component, Each, Serves, Writes, channel
from lcmtypes.core import acknowledgement_t
from lcmtypes.crane import haul_t, tally_t


class Crane(Component):
    stage = "act"
    clock: Clock
    hauls: Each[Serves[haul_t]] = channel("*/haul")

    def loop(self) -> None:
        for hauls in self.hauls.values():
            for command in list(hauls.open):
                command.done()
            for command in hauls:
                command.accept()


class Robot(Component):
    stage = "think"
    haul: Calls[haul_t]
    tally: Writes[tally_t]

    def init(self) -> None:
        self.future: Call[acknowledgement_t] | None = None

    def loop(self) -> None:
        tally = self.tally.value
        if self.future and self.future.finished:
            tally.done += self.future.done
            tally.failed += not self.future.done
        if not self.future or self.future.finished:
            self.future = self.haul.call()
        self.tally.write()
