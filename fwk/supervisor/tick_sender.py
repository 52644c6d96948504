"""Ticks on their way to the hosts: said to everybody of a stage, and again to whoever has not answered."""

from collections.abc import Iterable, Sequence
from collections.abc import Set as AbstractSet

from fwk.bus import sync
from fwk.bus.sender import Sender
from fwk.engine.visibility import Ledger
from fwk.model.ports import Ports
from fwk.supervisor.processes.host_process import HostEntry
from fwk.supervisor.tick_log import put_changes, void_messages
from lcmtypes.core import protocol_t, tick_t


class Telling:
    """Tells ticks, and keeps what hosts that are late owe an answer to."""

    def __init__(self, run: int, ports: Ports, ledger: Ledger, sender: Sender) -> None:
        self._run = run
        self._ports = ports
        self._ledger = ledger
        self._sender = sender
        self._told = b""  # the newest tick as it was sent
        self._owed: dict[int, tuple[bytes, int]] = {}  # the tick that a late host works on, or lost, and its stage

    def broadcast(
        self,
        number: int,
        time_us: int,
        stage: int,
        place: int,
        main_loop: int,
        members: Sequence[HostEntry],
        outstanding: AbstractSet[int],
    ) -> None:
        """Tells a tick to those of a stage who have not answered yet, with all that any of them has not seen."""
        told = [entry for entry in members if entry.index in outstanding and entry.state == "running"]
        if not told:
            return
        since = min(entry.seen for entry in told)
        tick = tick_t()
        tick.version, tick.run, tick.tick, tick.step = protocol_t.VERSION, self._run, number, place
        tick.time_us, tick.main_loop = time_us, main_loop
        tick.channel, tick.sequence = self._ledger.news(stage, since)
        tick.voids = void_messages(self._ledger, since)
        tick.absent = [entry.index for entry in members if entry not in told]
        changes = {change.number: change for entry in told for change in entry.changes}
        put_changes(tick, [changes[number] for number in sorted(changes)])
        self._told = sync.encode_tick(tick)
        self._sender.publish(sync.TICK, self._told, self._ports.stage(stage))

    def owe(self, entry: HostEntry, members: Sequence[HostEntry], stage: int) -> None:
        """Keeps the newest tick for a host that is late with it.

        For that host alone: one that is started meanwhile must not take it for its first.
        """
        tick: tick_t = sync.decode_tick(self._told)
        tick.absent = [other.index for other in members if other is not entry]
        self._owed[entry.index] = (sync.encode_tick(tick), stage)

    def remind(self, table: Iterable[HostEntry]) -> None:
        """Who is late may have lost its tick, or its done was lost: the tick is repeated until it is answered."""
        for entry in table:
            if entry.busy:
                owed, stage = self._owed[entry.index]
                self._sender.publish(sync.TICK, owed, self._ports.stage(stage))
