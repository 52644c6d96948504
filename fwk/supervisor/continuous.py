"""Continuous components: each tick tells them what is visible, and what they have done is taken whenever it comes."""

from collections import deque

from fwk.bus import sync
from fwk.bus.sender import Sender
from fwk.engine.visibility import Ledger
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.model.tick_events import TickTold
from fwk.supervisor.processes.host_process import HostEntry
from fwk.supervisor.tick_log import Records, put_changes, void_messages
from lcmtypes.core import done_t, protocol_t, taken_t, tick_t

_TICKS_KEPT = 4096


class Continuous:
    """The hosts of continuous components. The main loop never waits for one.

    A host has one done under way: it repeats it until it gets it back, and only then runs again. So each iteration is
    taken once and in order, whatever is lost.
    """

    def __init__(
        self, plan: Plan, run: int, table: list[HostEntry], ledger: Ledger, sender: Sender, records: Records
    ) -> None:
        self.hosts = {component.host for component in plan.components if component.rate_hz is not None}
        self.entries = [entry for entry in table if entry.index in self.hosts]
        self._run = run
        self._ledger = ledger
        self._sender = sender
        self._ports = Ports.of(plan)
        self._records = records
        self._steps: deque[tuple[int, int]] = deque(
            maxlen=_TICKS_KEPT
        )  # of the newest ticks: number, step of the ledger
        self._taken: dict[int, tuple[int, int, int]] = {}  # by host: incarnation, tick and number of the newest done

    def tell(self, tick: int, time_us: int, main_loop: int) -> None:
        """A tick begins: from now on these marks count."""
        step = self._ledger.begin()
        self._steps.append((tick, step))
        self._records.event(TickTold())
        for entry in self.entries:
            if entry.state == "running":
                self._sender.send(sync.TICK, self._message(entry, tick, time_us, main_loop), self._port(entry))

    def take(self, entry: HostEntry, done: done_t) -> bool:
        """An iteration has ended; false if it is known already, or no continuous one's."""
        if entry.index not in self.hosts or done.kind != done_t.ITERATION:
            return False
        self._sender.send(sync.TAKEN, sync.taken(done, taken_t.SUPERVISOR), self._port(entry))
        this = (done.incarnation, done.tick, done.iteration)
        if this <= self._taken.get(entry.index, (0, 0, 0)):
            return False
        self._taken[entry.index] = this
        entry.seen = next((step for tick, step in reversed(self._steps) if tick == done.tick), 0)
        return True

    def _port(self, entry: HostEntry) -> int:
        return self._ports.host(entry.index)

    def _message(self, entry: HostEntry, tick: int, time_us: int, main_loop: int) -> bytes:
        made = tick_t()
        made.version, made.run, made.tick, made.step = protocol_t.VERSION, self._run, tick, -1
        made.time_us, made.main_loop = time_us, main_loop
        made.channel, made.sequence = self._ledger.news_of(entry.index, entry.seen)
        made.voids = void_messages(self._ledger, entry.seen)
        put_changes(made, entry.changes)
        return sync.encode_tick(made)
