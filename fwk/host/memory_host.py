"""Runs one host in memory, step by step: for replays and for systems without processes."""

from collections.abc import Callable, Mapping
from functools import partial

from fwk.bus import sync
from fwk.bus.memory_network import MemoryNetwork, MemorySocket
from fwk.bus.sockets import GROUP, LOOPBACK, Address
from fwk.component.component import Component
from fwk.engine.assignment import Assignment
from fwk.engine.component_group import Written
from fwk.engine.runner import Runner
from fwk.engine.visibility import Visibility
from fwk.host.continuous import host_of
from fwk.host.hooks import ProcessHooks, imported_class
from fwk.lcm import wire
from fwk.lcm.messages import sequence_of
from fwk.model.channel_table import facts_in
from fwk.model.plan import ComponentPlan
from fwk.model.ports import Ports
from lcmtypes.core import (
    channels_change_t,
    done_t,
    fetch_t,
    gone_t,
    leaving_t,
    log_t,
    protocol_t,
    settings_change_t,
    taken_t,
    tick_t,
)

_WAITS_MAX = 100_000
_NUMBER = 0  # LCM numbers the messages of a sender; only fragments need it


class HostStuckError(Exception):
    """A host in memory waits for something that cannot come."""


class MemoryHost:
    """A host participant whose ticks and messages come from its owner.

    Args:
        assignment: data that the host is given.
        ledger: the marks of the run.
        on_log: takes each line that the host logs; None: lines are dropped.
        find_class: returns the class of a component.
    """

    def __init__(
        self,
        assignment: Assignment,
        ledger: Visibility,
        on_log: Callable[[log_t], None] | None = None,
        find_class: Callable[[ComponentPlan], type[Component]] = imported_class,
    ) -> None:
        self._ports = Ports.of(assignment.plan)
        self._run = assignment.run
        self._index = assignment.host
        self._own_port = self._ports.host(assignment.host)
        self._gateway_port = self._ports.host(self._ports.gateway)
        self._first_channel = self._ports.channel(0)
        self._ledger = ledger
        self._step = -1  # step of the ledger when a tick last carried the marks
        self._settings: list[settings_change_t] = []  # changes that the next tick carries
        self._channels: list[channels_change_t] = []
        self._components = assignment.plan.hosts[assignment.host].components
        self._on_log = on_log
        self._stops = False
        self._written: Written = []
        self._done: done_t | None = None
        self._answered: tuple[int, int, int, int] | None = None  # the newest done
        self._assembler = wire.Assembler()
        self._names: dict[int, bytes] = {
            self._ports.channel(channel.index): channel.name.encode() for channel in assignment.plan.channels
        }
        self._missing: set[tuple[int, int]] = set()  # port and sequence number of messages that never come
        self._losing: set[int] = set()  # ports whose sockets may hold such messages
        # By port of a channel that is about to open: number of the change that opens it, messages since then.
        self._expected: dict[int, tuple[int, list[bytes]]] = {}
        self._told = 0  # number of the newest change that the host has
        self._network = MemoryNetwork(self._sent, self._opened)
        hooks = ProcessHooks(stopping=lambda: self._stops, find_class=find_class, reports=False)
        self.host = host_of(assignment, self._network, hooks)
        self._steps = self.host.serve()
        self._until_us = 0

    @property
    def runners(self) -> Mapping[str, Runner]:
        """The runners of the host's components, by name."""
        return self.host.group.runners

    def init(self) -> None:
        """Builds and initialises the components.

        Raises:
            ComponentFailedError: a component raised.
        """
        self._until_us = next(self._steps)

    def put(self, channel: int, data: bytes) -> None:
        """Delivers a message of the channel with this index; channels that no component reads are ignored."""
        port = self._ports.channel(channel)
        self._deliver(port, data)
        if port in self._expected:  # also if a socket is open: it may be closed and opened again
            self._expected[port][1].append(data)

    @property
    def has_changes(self) -> bool:
        """Whether there are changes that no tick has carried yet."""
        return bool(self._settings or self._channels)

    def set(self, change: settings_change_t) -> None:
        """Takes settings of a component of the host; the next tick carries them."""
        self._settings.append(change)

    def decide(self, change: channels_change_t, newest: Mapping[int, bytes]) -> None:
        """Takes decisions about channels; the next tick carries them.

        Args:
            change: the decisions.
            newest: the newest visible message of each channel, by index.
        """
        self._channels.append(change)
        for fact in facts_in(change):
            opened = fact.channel
            if fact.kind == "read" and fact.component in self._components and opened:
                port = self._ports.channel(opened.index)
                self._names[port] = opened.name.encode()
                begin = [newest[opened.index]] if opened.index in newest else []
                # An earlier decision that the host does not have yet needs the messages since then.
                self._expected[port] = change.number, self._expected.get(port, (0, begin))[1]

    def compose(self, tick: int, step: int, time_us: int, holder: int) -> tick_t:
        """Returns the tick that a supervisor sends to this host, with the present marks."""
        made = tick_t()
        made.version, made.run, made.tick, made.step = protocol_t.VERSION, self._run, tick, step
        made.time_us, made.main_loop = time_us, holder
        made.channel, made.sequence = self._ledger.news_of(self._index, self._step)
        made.n_marks = len(made.channel)
        made.settings, self._settings = self._settings, []
        made.channels, self._channels = self._channels, []
        self._step = self._ledger.step
        return made

    def lose(self, channel: int, sequence: int) -> None:
        """Keeps a message from this host, which then fetches it in vain.

        The host may have it already: a search for another message empties the sockets.
        """
        if channel in self.host.inputs:
            self.host.inputs.buffer(channel).forget(sequence)
        port = self._ports.channel(channel)
        self._missing.add((port, sequence))
        self._losing.add(port)

    def tick(self, tick: tick_t, stage: int) -> tuple[Written, done_t]:
        """Runs the iterations of a tick in a stage; returns what they wrote, and the done.

        Raises:
            ComponentFailedError: a component raised.
        """
        self._send_tick(tick, (GROUP, self._ports.stage(stage)))
        return self._result()

    def tell(self, tick: tick_t) -> None:
        """Gives a continuous component the marks of a tick, for its next iteration."""
        self._send_tick(tick, (LOOPBACK, self._own_port))

    def iterate(self) -> tuple[Written, done_t]:
        """Runs the next iteration of a continuous component on its newest marks.

        Raises:
            ComponentFailedError: the component raised.
        """
        return self._result()

    def finalize(self) -> tuple[Written, done_t]:
        """Finalizes the components; returns what they wrote, and the final done.

        Raises:
            ComponentFailedError: a component raised.
        """
        self._stops = True
        self._until_us = min(self._until_us, self._network.clock_us)
        result = self._result(final=True)
        self.close()
        return result

    def close(self) -> None:
        """Ends the host like a killed process."""
        self._steps.close()

    def _send_tick(self, tick: tick_t, address: Address) -> None:
        self._told = max((change.number for change in tick.channels), default=self._told)
        self._put(sync.TICK, sync.encode_tick(tick), address, self._ports.supervisor)

    def _result(self, final: bool = False) -> tuple[Written, done_t]:
        """Resumes the host until it sends a done that it has not sent before."""
        self._written, self._done = [], None
        self._drop_missing()
        for _ in range(_WAITS_MAX):
            self._until_us = self._network.run(self._steps, self._until_us)
            if self._done:
                break
            self._until_us = self._network.run_once(self._steps, self._until_us)
            if self._done:
                break
        else:
            raise HostStuckError(f"host {self._index} does not finish its iteration")
        done = self._done
        if self._expected:
            self._expected = {port: kept for port, kept in self._expected.items() if kept[0] > self._told}
        if not final and self._is_continuous:
            taken = sync.taken(done, taken_t.SUPERVISOR)
            self._put(sync.TAKEN, taken, (LOOPBACK, self._own_port), self._ports.supervisor)
        return self._written, done

    def _drop_missing(self) -> None:
        """Removes messages that never arrive from the sockets in which they wait."""
        for port in sorted(self._losing):
            begin = len(wire.in_one(_NUMBER, self._names.get(port, b""), b""))
            unwanted = partial(self._is_missing, port, begin)
            self._network.drop((GROUP, port), unwanted)
        self._losing.clear()

    def _is_missing(self, port: int, begin: int, datagram: bytes) -> bool:
        return (port, sequence_of(datagram[begin:])) in self._missing

    @property
    def _is_continuous(self) -> bool:
        return self.host.group.plans[0].rate_hz is not None

    def _deliver(self, port: int, data: bytes) -> bool:
        name = self._names.get(port)
        if name is None:  # a dynamic channel that no component here uses
            return False
        if (port, sequence_of(data)) in self._missing:
            return True
        return self._put(name, data, (GROUP, port), self._gateway_port)

    def _put(self, channel: bytes, data: bytes, address: Address, port: int) -> bool:
        return self._network.put(wire.in_one(_NUMBER, channel, data), address, port)

    def _opened(self, socket: MemorySocket) -> None:
        """Fills the socket of a dynamic channel."""
        for data in self._expected.get(socket.port, (0, []))[1]:
            self._deliver(socket.port, data)

    def _sent(self, datagram: bytes, address: Address) -> None:
        message = self._assembler.feed(datagram, self._own_port)
        if message is None:
            return
        channel, data = message
        if address[1] >= self._first_channel:
            self._written.append((channel.decode(), data))
        elif channel == sync.DONE:
            self._take_done(sync.decode_done(data))
        elif channel == b"fwk/log":
            if self._on_log:
                self._on_log(log_t.decode(data))
        elif channel == b"fwk/fetch":
            self._answer(fetch_t.decode(data))
        elif channel == sync.LEAVING:
            self._see_off(sync.decode_leaving(data))

    def _see_off(self, leaving: leaving_t) -> None:
        """Answers in the gateway's place that every message has arrived."""
        taken = taken_t()
        taken.run, taken.taker, taken.kind = self._run, self._ports.gateway, done_t.FINAL
        taken.incarnation = leaving.incarnation
        self._put(sync.TAKEN, taken.encode(), (LOOPBACK, self._own_port), self._gateway_port)

    def _take_done(self, done: done_t) -> None:
        this = (done.kind, done.tick, done.step, done.iteration)
        if this != self._answered:  # otherwise it is repeated
            self._answered, self._done = this, done

    def _answer(self, fetch: fetch_t) -> None:
        """Answers that the messages are gone: all others were delivered before."""
        gone = gone_t()
        gone.run, gone.channel = self._run, fetch.channel
        gone.first_sequence, gone.last_sequence = fetch.first_sequence, fetch.last_sequence
        self._put(b"fwk/gone", gone.encode(), (LOOPBACK, self._own_port), self._gateway_port)
