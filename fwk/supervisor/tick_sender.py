"""Broadcasts ticks to the hosts of a stage and repeats them until answered."""

from collections.abc import Set as AbstractSet
from typing import NamedTuple

from fwk.bus import sync
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.tick_log import put_changes, void_messages
from lcmtypes.core import protocol_t, tick_t


class Tick(NamedTuple):
    """The running tick."""

    number: int
    time_us: int
    """Logical time."""
    main_loop: int
    """Component that has the main loop."""


class Turn(NamedTuple):
    """One run of a stage in a tick."""

    step: int
    """Position in the schedule; the index of the stage if no component has the main loop."""
    stage: int
    hosts: list[HostProcess]


class TickSender:
    """Sends ticks, and keeps those that late hosts have not answered yet."""

    def __init__(self, core: Core) -> None:
        self._core = core
        self._sent = b""  # the newest tick as it was sent
        self._unanswered: dict[int, tuple[bytes, int]] = {}  # by late host: the tick, and its stage

    def broadcast(self, tick: Tick, turn: Turn, outstanding: AbstractSet[int]) -> None:
        """Sends a tick to the hosts of a stage that have not answered yet, with everything that any of them lacks."""
        told = [host for host in turn.hosts if host.index in outstanding and host.running]
        if not told:
            return
        ledger = self._core.ledger
        since = min([host.answered_step for host in told])
        made = tick_t()
        made.version, made.run, made.tick, made.step = protocol_t.VERSION, self._core.run, tick.number, turn.step
        made.time_us, made.main_loop = tick.time_us, tick.main_loop
        made.channel, made.sequence = ledger.news(turn.stage, since)
        made.voids = void_messages(ledger, since)
        if len(told) < len(turn.hosts):
            made.absent = [host.index for host in turn.hosts if host not in told]
        changes = {change.number: change for host in told for change in host.changes}
        if changes:
            put_changes(made, [changes[number] for number in sorted(changes)])
        self._sent = sync.encode_tick(made)
        self._core.sender.publish(sync.TICK, self._sent, self._core.ports.stage(turn.stage))

    def keep_for(self, host: HostProcess, turn: Turn) -> None:
        """Keeps the newest tick for a host that is late with it.

        The copy names all other hosts as absent: a host that starts later must not take it as its first tick.
        """
        tick: tick_t = sync.decode_tick(self._sent)
        tick.absent = [other.index for other in turn.hosts if other is not host]
        self._unanswered[host.index] = (sync.encode_tick(tick), turn.stage)

    def remind(self) -> None:
        """Repeats the ticks of late hosts: the tick or its done may have been lost."""
        for host in self._core.hosts:
            if host.late_with:
                data, stage = self._unanswered[host.index]
                self._core.sender.publish(sync.TICK, data, self._core.ports.stage(stage))
