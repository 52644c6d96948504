"""Writes many messages in each tick."""

from fwk import Component, Writes
from lcmtypes.core import acknowledgement_t


class Burst(Component):
    stage = "think"
    note: Writes[acknowledgement_t]

    def loop(self) -> None:
        for _ in range(200):
            self.note.write()
