"""A supervisor in memory: the test plays its hosts, gateway and network in one thread."""

import signal
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from fwk import Component
from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.sockets import LOOPBACK, Address
from fwk.bus.waiting import Source
from fwk.engine.assignment import Start
from fwk.engine.lookahead import lookahead
from fwk.lcm import wire
from fwk.model.plan import NOBODY
from fwk.model.ports import Ports
from fwk.supervisor.options import RunOptions
from fwk.supervisor.processes.starter import Ended, Started
from fwk.supervisor.supervisor import Machine, Supervisor
from fwk.testing.plans import plan_of
from lcmtypes.core import (
    actual_t,
    component_state_t,
    done_t,
    histogram_t,
    log_t,
    recorded_t,
    status_t,
    tick_record_t,
    tick_t,
)

STEPS_MAX = 30_000
RUN = 4711
S = 1_000_000


class MemorySocket:
    """A socket whose datagrams go to the run that plays the other processes."""

    def __init__(self, run: "MemoryRun", descriptor: int, port: int) -> None:
        self.port = port
        self.waiting: deque[tuple[bytes, Address]] = deque()
        self._run = run
        self._descriptor = descriptor

    def recvfrom(self, _size: int) -> tuple[bytes, Address]:
        if not self.waiting:
            raise BlockingIOError
        return self.waiting.popleft()

    def sendto(self, data: bytes, address: Address) -> int:
        self._run.sent(data, self.port, address[1])
        return len(data)

    def fileno(self) -> int:
        return self._descriptor

    def close(self) -> None:
        self.waiting.clear()


class MemoryRun:
    """Plays hosts that answer at once, unless the test prevents it, and a gateway that takes every record.

    It is both network and process starter of the supervisor; wall time jumps to the end of each wait.
    """

    def __init__(self, components: dict[str, type[Component]], **fields: Any) -> None:
        plan = plan_of(components, **{"loop_time_warnings": False, **fields})
        self.plan = plan
        self.ports = Ports.of(plan)
        self.wall_us = S
        self.ticks: list[tick_t] = []
        self.records: list[tick_record_t] = []
        self.record_ticks: list[int] = []
        """Ticks of all records that were sent, also of repeated ones."""
        self.gateway_stands_still = False
        self.lines: list[log_t] = []
        self.statuses: list[status_t] = []
        self.starts: list[tuple[int, Start]] = []
        self.killed: list[int] = []
        self.does_not_answer: set[int] = set()
        """Hosts whose iterations do not end."""
        self.does_not_start: set[int] = set()
        """Hosts whose `init` does not end."""
        self.does_not_stop: set[int] = set()
        """Hosts whose `finalize` does not end."""
        self.loses_dones: set[tuple[int, int]] = set()
        """Hosts and steps whose dones do not arrive."""
        self.alters: Callable[[done_t], None] = lambda _: None
        """Changes a done before it is sent."""
        self._incarnation: dict[int, int] = {}
        self._lookahead = lookahead(plan)
        self._events: deque[Started | Ended] = deque()
        self._sockets: dict[int, MemorySocket] = {}
        self._watched: set[int] = set()
        self._assembler = wire.Assembler()
        self.supervisor = Supervisor(plan, RunOptions(Path(), speed=0.0), RUN, self, Machine(self))
        self._gateway_done(0)
        self._steps: Steps[Any] | None = None

    def begin(self) -> None:
        """Starts all hosts."""
        self.play(lambda: len(self.records) >= 1)

    def play(self, until: Callable[[], bool], longest_us: int = 600 * S) -> None:
        """Runs the supervisor until `until()` is true.

        Raises:
            AssertionError: it is still false after the wall time `longest_us`, or after `STEPS_MAX` steps; steps take
            no wall time while ticks follow each other.
        """
        if not self._steps:
            self._steps = self.supervisor.work(_Gateway())
            self._until_us = next(self._steps)
        end_us, steps = self.wall_us + longest_us, 0
        while not until():
            steps += 1
            assert steps < STEPS_MAX, f"not within {STEPS_MAX} steps: {self.texts}"
            assert self.wall_us < end_us, f"not within {longest_us / S:g} s: {self.texts}"
            readable = [each for each in self._watched if each in self._sockets and self._sockets[each].waiting]
            if self._events:
                readable.append(self.fileno())
            if not readable:
                self.wall_us = max(self.wall_us, self._until_us)
            self._until_us = self._steps.send(readable)

    def play_ticks(self, count: int) -> None:
        """Runs that number of further ticks."""
        last = len(self.records) + count
        self.play(lambda: len(self.records) >= last)

    @property
    def texts(self) -> list[str]:
        """Returns the texts of all log lines of the supervisor."""
        return [line.text for line in self.lines]

    def ready(self, host: int) -> None:
        """Ends the `init` of a host."""
        actual = actual_t()
        actual.run, actual.host, actual.incarnation = RUN, host, self._incarnation[host]
        for index in self.plan.hosts[host].components:
            state = component_state_t()
            state.name, state.state = self.plan.components[index].name, "running"
            actual.components.append(state)
            actual.times.append(histogram_t())
        actual.n = len(actual.components)
        self.report(b"fwk/actual", actual.encode(), self.ports.host(host))

    def done(self, host: int, tick: int, step: int, sequence: int = 0, kind: int = done_t.STAGE) -> None:
        """Sends a done of a host, whose components write one message each if `sequence` is not 0."""
        made = done_t()
        made.run, made.host, made.incarnation, made.kind = RUN, host, self._incarnation[host], kind
        made.tick, made.step = tick, step
        made.next_time_us = -1
        own = [each.index for each in self.plan.channels if each.writer in self.plan.hosts[host].components]
        made.channel = own if sequence else []
        made.sequence = [sequence] * len(made.channel)
        self.alters(made)
        self.report(sync.DONE, sync.encode_done(made), self.ports.host(host))

    def end(self, host: int, code: int) -> None:
        """Ends the process of a host."""
        self._events.append(Ended(host, self._incarnation[host], 100 + host, code))

    def report(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to the supervisor's port for dones."""
        self.send_to(self.ports.sync, channel, data, port)

    def send_to(self, to: int, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to one of the supervisor's ports."""
        for each in self._sockets.values():
            if each.port == to:
                each.waiting.extend((datagram, (LOOPBACK, port)) for datagram in wire.datagrams(1, channel, data))

    def sent(self, datagram: bytes, _source: int, port: int) -> None:
        """Takes a datagram of the supervisor."""
        message = self._assembler.feed(datagram, port)
        channel, data = message or (b"", b"")
        if channel == sync.TICK:
            self._tick(sync.decode_tick(data), port - self.ports.stage(0))
        elif channel == sync.RECORD:
            record: tick_record_t = sync.decode_record(data)
            self.record_ticks.append(record.tick)
            if self.gateway_stands_still:
                return
            if not self.records or record.tick > self.records[-1].tick:
                self.records.append(record)
            self._gateway_done(record.tick)
        elif channel == b"fwk/status":
            self.statuses.append(status_t.decode(data))
        elif channel == b"fwk/log":
            self.lines.append(log_t.decode(data))

    def _tick(self, tick: tick_t, stage: int) -> None:
        self.ticks.append(tick)
        for host in self.plan.hosts:
            stages = {each for index in host.components for each in self.plan.components[index].stages}
            takes_part = stage in stages and host.index not in tick.absent
            if takes_part and host.index not in self.does_not_answer and self._incarnation.get(host.index):
                for step in self._steps_of(host.index, tick, stage):
                    if (host.index, step) not in self.loses_dones:
                        self.done(host.index, tick.tick, step, sequence=tick.tick)

    def _steps_of(self, host: int, tick: tick_t, stage: int) -> list[int]:
        """Returns the steps that a host runs on the marks of a tick."""
        if tick.main_loop != NOBODY:
            return [tick.step]
        ahead = self._lookahead[host]
        return [each for each in ahead if stage <= each <= ahead[stage]]

    def _gateway_done(self, tick: int) -> None:
        made = recorded_t()
        made.run, made.tick, made.change = RUN, tick, 1 << 30  # the gateway listens to every dynamic channel
        self.report(sync.RECORDED, sync.encode_recorded(made), self.ports.host(self.ports.gateway))

    # network

    def now_us(self) -> int:
        self.wall_us += 1
        return self.wall_us

    def group_socket(self, port: int) -> MemorySocket:
        return self._socket(port)

    def own_socket(self, port: int) -> MemorySocket:
        return self._socket(port)

    def _socket(self, port: int) -> MemorySocket:
        made = MemorySocket(self, 10 + len(self._sockets), port)
        self._sockets[made.fileno()] = made
        return made

    def watch(self, source: Source) -> None:
        self._watched.add(source if isinstance(source, int) else source.fileno())

    def unwatch(self, source: Source) -> None:
        self._watched.discard(source if isinstance(source, int) else source.fileno())

    # process starter

    def fileno(self) -> int:
        return 1

    def start(self, host: int, start: Start, fresh_code: bool) -> None:
        self.starts.append((host, start))
        self._incarnation[host] = start.incarnation
        self._events.append(Started(host, start.incarnation, 100 + host))
        if host not in self.does_not_start:
            self.ready(host)

    def signal(self, pid: int, number: int) -> None:
        host = pid - 100
        if number == signal.SIGKILL:
            self.killed.append(host)
            self.end(host, -9)
        elif number == signal.SIGTERM and host not in self.does_not_stop:
            self.finalize(host)

    def finalize(self, host: int) -> None:
        """Ends the `finalize` of a host, and its process."""
        self.done(host, self.supervisor.loop.tick, -1, kind=done_t.FINAL)
        self.end(host, 0)

    def wake(self) -> None:
        pass

    def events(self) -> list[Started | Ended]:
        found = list(self._events)
        self._events.clear()
        return found

    def debugs(self, _host: int) -> bool:
        return False

    def component_at(self, host: int) -> int:
        return self.plan.hosts[host].components[0] if host in self.does_not_answer else NOBODY


class _Gateway:
    def fileno(self) -> int:
        return 2

    def gateway_end(self) -> str:
        return "exit code 0"
