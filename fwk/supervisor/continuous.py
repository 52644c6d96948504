"""Hosts of continuous components: each tick carries the visible marks; their dones are taken whenever they come."""

from collections import deque

from fwk.bus import sync
from fwk.model.tick_events import TickTold
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess, HostState
from fwk.supervisor.tick_log import TickLog, put_changes, void_messages
from fwk.supervisor.tick_sender import Tick
from lcmtypes.core import done_t, protocol_t, taken_t, tick_t

_TICKS_KEPT = 4096


class ContinuousHosts:
    """The hosts of continuous components, for which the main loop never waits.

    A host has at most one done under way: it repeats the done until its receipt is confirmed, and only then runs
    again. So each iteration is taken once and in order, whatever is lost.
    """

    def __init__(self, core: Core, tick_log: TickLog) -> None:
        self._core = core
        self._tick_log = tick_log
        self._hosts = [host for host in core.hosts if host.continuous]
        self._ledger_steps: deque[tuple[int, int]] = deque(maxlen=_TICKS_KEPT)  # newest ticks with their ledger steps
        self._taken: dict[int, tuple[int, int, int]] = {}  # by host: incarnation, tick and number of the newest done

    def tell(self, tick: Tick) -> None:
        """Sends all hosts the marks from the beginning of a tick."""
        if not self._hosts:
            return
        step = self._core.ledger.begin()
        self._ledger_steps.append((tick.number, step))
        self._tick_log.event(TickTold())
        for host in self._hosts:
            if host.running:
                self._core.sender.send(sync.TICK, self._message(host, tick), self._port(host))

    def counts(self, host: HostProcess, done: done_t) -> bool:
        """Confirms a done to its host; returns whether the iteration was not taken before."""
        if done.kind != done_t.ITERATION or not (host.alive or host.state is HostState.STOPPING):
            return False
        self._core.sender.send(sync.TAKEN, sync.taken(done, taken_t.SUPERVISOR), self._port(host))
        return (done.incarnation, done.tick, done.iteration) > self._taken.get(host.index, (0, 0, 0))

    def take(self, host: HostProcess, done: done_t) -> None:
        """Notes an iteration that has ended."""
        self._taken[host.index] = (done.incarnation, done.tick, done.iteration)
        steps = (step for tick, step in reversed(self._ledger_steps) if tick == done.tick)
        host.answered_step = next(steps, 0)

    def _port(self, host: HostProcess) -> int:
        return self._core.ports.host(host.index)

    def _message(self, host: HostProcess, tick: Tick) -> bytes:
        ledger = self._core.ledger
        made = tick_t()
        made.version, made.run, made.tick, made.step = protocol_t.VERSION, self._core.run, tick.number, -1
        made.time_us, made.main_loop = tick.time_us, tick.main_loop
        made.channel, made.sequence = ledger.news_of(host.index, host.answered_step)
        made.voids = void_messages(ledger, host.answered_step)
        put_changes(made, host.changes)
        return sync.encode_tick(made)
