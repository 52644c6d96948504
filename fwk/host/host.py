"""The host process: answers each tick with one iteration of each of its components and one done."""

import json
import select
import socket
import struct
import traceback
from bdb import BdbQuit
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib import import_module

from fwk.aspects.logging import Logger
from fwk.aspects.vision import Ring
from fwk.bus import sync, wire
from fwk.bus.inbox import Box
from fwk.bus.ports import Ports
from fwk.bus.sockets import Sender, multicast_receiver
from fwk.clock import US_PER_S, Clock, monotonic_us
from fwk.declaration import declaration
from fwk.host.inputs import Inputs
from fwk.host.memory import lift_limit
from fwk.host.outputs import Outputs
from fwk.host.process import give_memory_back
from fwk.host.progress import Progress
from fwk.host.report import Complaints, Figures, told
from fwk.messages import MessageError
from fwk.plan.model import NOBODY, ComponentPlan, Plan
from fwk.plan.starting import start_order
from fwk.port import DeclarationError
from fwk.runner import AWAY_TICKS, Runner, Surroundings
from lcmtypes.core import actual_t, change_t, done_t, fetch_t, gone_t, log_t, tick_t

READY_REPORT_MS = 100  # how often a host says that it is ready until its first tick comes
REPORT_US = US_PER_S


@dataclass(frozen=True)
class Assignment:
    """What a host process is told when it starts."""

    plan: Plan
    host: int
    run: int
    incarnation: int
    sequences: Mapping[str, int]
    """Sequence numbers that its channels have reached, for one that was restarted."""
    rings: Mapping[str, Ring]
    settings: Mapping[str, str] = field(default_factory=dict)
    """Settings of its components that were changed since the run began, by name, as JSON."""
    fresh_code: bool = False
    """Whether it imports the application's modules anew."""
    progress: Progress | None = None
    """Where it says which of its components works."""


class Failure(Exception):  # noqa: N818 - a failure of a component, not an error of the framework
    """A component failed; the text says which, where and why."""


class Host:
    """Takes its components from `init` to `finalize`."""

    def __init__(
        self,
        assignment: Assignment,
        stopping: Callable[[], bool],
        wakeup: int,
        make_runner: Callable[..., Runner] = Runner,
    ) -> None:
        plan = assignment.plan
        self._assignment = assignment
        self._plan = plan
        self._stopping = stopping
        self._make_runner = make_runner
        self._ports = Ports.of(plan)
        self._supervisor_port, self._sync_port = self._ports.supervisor, self._ports.sync
        self._sender = Sender(self._ports.host(assignment.host))
        self._own = [plan.components[index] for index in plan.hosts[assignment.host].components]
        self.figures = {component.name: Figures(component.name) for component in self._own}
        self._clock = Clock(plan.period_us)
        self.log = Logger(plan.hosts[assignment.host].name, self._clock, self._send_log)
        self._complaints = Complaints(self.log)
        indices = {component.index for component in self._own}
        written = {channel.name: channel for channel in plan.channels if channel.writer in indices}
        read = [channel for channel in plan.channels if indices & set(channel.readers)]
        local = [channel for channel in read if channel.name in written]
        self.inputs = Inputs(
            plan,
            read,
            local,
            assignment.host,
            assignment.run,
            self._sender,
            self._complaints,
            restarted=assignment.incarnation > 1,
        )
        self._outputs = Outputs(written, self._ports, self._sender, self.inputs.local, assignment.sequences)
        stages = sorted({stage for component in self._own for stage in component.stages})
        listening = [(stage, multicast_receiver(self._ports.stage(stage))) for stage in stages]
        self._sockets = {source.fileno(): (stage, source) for stage, source in listening}
        self._poller = select.epoll()  # unlike poll() it does not look at every socket again each time
        for descriptor in (*self._sockets, self._sender.socket.fileno(), wakeup):
            self._poller.register(descriptor, select.EPOLLIN)
        self._runners: dict[str, Runner] = {}
        self._index = {component.name: component.index for component in self._own}
        self._progress = assignment.progress if len(self._own) > 1 else None  # one alone needs no telling apart
        self._takers: list[Runner] = []  # those that may take over the main loop
        self._wishing: list[Runner] = []  # those that may ask something of the main loop
        self._stage_names = plan.stages
        self._members = [
            [component.name for component in self._own if stage in component.stages]
            for stage in range(len(plan.stages))
        ]
        self._waiting: dict[str, dict[str, list[bytes]]] = {}  # what each component has not seen yet, by channel
        self._readers: dict[int, list[str]] = {
            channel.index: [plan.components[reader].name for reader in channel.readers if reader in indices]
            for channel in read
        }
        self._answered = (0, -1)  # the newest (tick, stage) done
        self._done = b""
        self._message = done_t()  # the next done; what stays the same in it is written once
        self._message.run, self._message.host = assignment.run, assignment.host
        self._message.incarnation = assignment.incarnation
        self._configured = 0  # number of the newest change of settings taken over
        self._report_us = 0

    def serve(self) -> None:
        """Initialises the components, answers ticks until it is told to stop, finalizes the components.

        Raises:
            Failure: a component raised.
        """
        try:
            self._init()
            while not self._stopping():
                for descriptor, _ in self._poller.poll(0.001 * READY_REPORT_MS if self._answered[0] == 0 else 1):
                    source = self._sockets.get(descriptor)
                    tick = self._receive_tick(source[1]) if source else None
                    if source and tick:
                        self._answer(tick, source[0])
                    elif not source:
                        self._handle_own()
                if monotonic_us() >= self._report_us:
                    self._report()
            self._finalize()
        except MemoryError as error:  # between two iterations
            self._blame(self._own[0].name, "its process", error)
        finally:
            self._report()
            for runner in self._runners.values():
                runner.log.tell_dropped(at_the_end=True)

    def _init(self) -> None:
        for index in start_order(self._plan.components, [plan.index for plan in self._own]):
            plan = self._plan.components[index]
            self.figures[plan.name].state = "init"
            self._report()
            if self._progress:
                self._progress.works(self._assignment.host, index)
            with self._guard(plan.name, "init"):
                runner = self._runner(plan)
                self._runners[plan.name] = runner
                self._waiting[plan.name] = {}
                if runner.has_main_loop:
                    self._takers.append(runner)
                if runner.has_main_loop or runner.has_plugins:
                    self._wishing.append(runner)
                runner.init()
            self.figures[plan.name].state = "running"
        if self._progress:
            self._progress.works(self._assignment.host, NOBODY)
        give_memory_back()
        self._report()

    def _runner(self, plan: ComponentPlan) -> Runner:
        component = getattr(import_module(plan.module), plan.class_name)
        declared = declaration(component)
        surroundings = Surroundings(
            self._plan.seed,
            self._plan.period_us,
            self._send_log,
            self._assignment.rings,
            self._plan.log.lines_per_s,
            self._plan.stages,
            [component.name for component in self._plan.components],
        )
        if {port.attribute for port in declared.ports} != set(plan.channels):
            raise DeclarationError(f"{plan.module}: its ports are no longer those of the plan; start the run again")
        changed = self._assignment.settings.get(plan.name)
        settings = json.loads(changed) if changed else plan.config
        config = declared.config.model_validate(settings)
        incarnation = self._assignment.incarnation
        runner = self._make_runner(declared, plan.name, config, plan.channels, surroundings, incarnation)
        for channel, writer in runner.writers.items():
            writer.sequence = self._assignment.sequences.get(channel, 0)
        return runner

    def _finalize(self) -> None:
        """Finalizes the components and sends what they wrote, with a last done: it counts if the run goes on."""
        tick, time_us = max((runner.stamp.tick, runner.stamp.time_us) for runner in self._runners.values())
        written: list[tuple[str, bytes]] = []
        for name, runner in reversed(self._runners.items()):
            self.figures[name].state = "finalizing"
            if self._progress:
                self._progress.works(self._assignment.host, self._index[name])
            with self._guard(name, "finalize"):
                written += runner.finalize(tick, time_us)
            self.figures[name].state = "stopped"
        self._publish(written, tick, done_t.FINAL, -1, 0, "")

    def _receive_tick(self, source: socket.socket) -> tick_t | None:
        try:
            datagram, address = source.recvfrom(wire.DATAGRAM_MAX)
        except BlockingIOError:
            return None
        try:
            if address[1] != self._supervisor_port:
                raise MessageError(f"datagram from port {address[1]}, which is not the supervisor's")
            tick: tick_t = sync.decode_tick(wire.short(datagram)[1])
        except MessageError as error:
            self._complaints("fwk/tick", f"{error}; refused")
            return None
        return tick if tick.run == self._assignment.run else None

    def _answer(self, tick: tick_t, stage: int) -> None:
        if self._assignment.host in tick.absent:
            return
        this = (tick.tick, tick.stage)
        if this <= self._answered:
            if this == self._answered:
                self._sender.publish(sync.DONE, self._done, self._ports.sync)
            return
        self._clock.tick, self._clock.now_us = tick.tick, tick.time_us
        moved = self.inputs.advance(tick.channel, tick.sequence, tick.voids)
        if tick.tick > (self._answered[0] + AWAY_TICKS if self._answered[0] else 1):
            self.inputs.newest_only()
        if not self.inputs.wait(moved, self._handle_own):
            return
        if self._answered[0] == 0:
            self.inputs.forget_predecessor()
        self._deliver(moved)
        if tick.changes:
            self._configure(tick.changes)
        if self._takers:
            self._tell_holder(tick.main_loop)
        self._finish(tick, *self._run_members(tick, stage))
        self._answered = this

    def _deliver(self, moved: list[Box]) -> None:
        for box in moved:
            arrived, channel = box.take(), box.plan.name
            for name in self._readers[box.plan.index]:
                waiting = self._waiting[name]
                waiting[channel] = waiting[channel] + arrived if channel in waiting else arrived

    def _configure(self, changes: list[change_t]) -> None:
        for change in changes:
            plan = self._plan.components[change.component]
            if plan.name in self._runners and change.number > self._configured:
                with self._guard(plan.name, "config_changed"):
                    self._runners[plan.name].configure(json.loads(change.settings))
        self._configured = max(self._configured, *(change.number for change in changes))

    def _run_members(self, tick: tick_t, stage: int) -> tuple[list[tuple[str, bytes]], int, int]:
        """One iteration of each component of a stage: what they wrote, when the next tick is, how long it took."""
        written: list[tuple[str, bytes]] = []
        next_us = -1
        began_us = start_us = monotonic_us()
        for name in self._members[stage]:
            runner, waiting = self._runners[name], self._waiting[name]
            if self._progress:
                self._progress.works(self._assignment.host, self._index[name])
            self._waiting[name] = {}
            try:
                written += runner.iterate(tick.tick, tick.stage, self._stage_names[stage], tick.time_us, waiting)
            except BaseException as error:
                self._blame(name, f"loop, tick {tick.tick}", error)
                raise
            end_us = monotonic_us()
            self.figures[name].ran(end_us - start_us)
            start_us = end_us
            next_us = max(next_us, runner.time_source.next_us)
        if self._progress:
            self._progress.works(self._assignment.host, NOBODY)
        return written, next_us, start_us - began_us

    def _finish(self, tick: tick_t, written: list[tuple[str, bytes]], next_us: int, busy_us: int) -> None:
        """Sends what was written, and the done."""
        wishes = self._wishes() if self._wishing else ""
        self._publish(written, tick.tick, tick.stage, next_us, busy_us, wishes)

    def _publish(
        self, written: list[tuple[str, bytes]], tick: int, stage: int, next_us: int, busy_us: int, wishes: str
    ) -> None:
        marks = self._outputs.publish(written)
        done = self._message
        done.tick, done.stage, done.next_time_us, done.busy_us = tick, stage, next_us, busy_us
        done.wishes = wishes
        done.channel, done.sequence = list(marks), list(marks.values())
        self._done = sync.encode_done(done)
        self._sender.publish(sync.DONE, self._done, self._sync_port)

    def _tell_holder(self, component: int) -> None:
        """Says to who cares which component has the main loop."""
        name = self._plan.components[component].name if component != NOBODY else ""
        for runner in self._takers:
            runner.main_loop.holder = name

    def _wishes(self) -> str:
        """What the iterations asked for, in a done's words."""
        asked: dict[str, dict[str, object]] = {}
        for runner in self._wishing:
            for aspect, wish in runner.wishes().items():
                asked.setdefault(aspect, {})[runner.name] = wish
        return json.dumps(asked) if asked else ""

    def _handle_own(self) -> bool:
        """Handles what was sent to this host's own port; false when it is time to stop."""
        while True:
            try:
                message = self._sender.receive(self._ports.members)
                if message is None:
                    return not self._stopping()
                self._handle_message(*message)
            except (MessageError, ValueError, struct.error) as error:
                self._complaints("fwk/fetch", f"{error}; refused")

    def _handle_message(self, channel: bytes, data: bytes) -> None:
        if channel == b"fwk/fetch":
            fetch = fetch_t.decode(data)
            if fetch.run == self._assignment.run:
                self._outputs.answer(fetch)
        elif channel == b"fwk/gone":
            gone = gone_t.decode(data)
            if gone.run == self._assignment.run:
                self._give_up(gone)
        else:
            raise MessageError("neither fetch nor gone")

    def _give_up(self, gone: gone_t) -> None:
        lost = self.inputs.gone(gone)
        if lost:
            channel = self._plan.channels[gone.channel].name
            numbers = f"{gone.first_sequence} to {gone.last_sequence}"
            self.log.warning(f"{channel}: {lost} messages of {numbers} lost: their writer no longer has them")

    @contextmanager
    def _guard(self, name: str, moment: str) -> Iterator[None]:
        """Turns whatever a component raises into a `Failure` of that component."""
        try:
            yield
        except BaseException as error:
            self._blame(name, moment, error)
            raise

    def _blame(self, name: str, moment: str, error: BaseException) -> None:
        """Marks a component as failed and logs why, with the traceback.

        Raises:
            Failure: always, unless it is no failure of the component: somebody left the debugger, or ends the process.
        """
        if isinstance(error, BdbQuit | KeyboardInterrupt):
            return
        if isinstance(error, MemoryError):
            lift_limit()
        place = traceback.extract_tb(error.__traceback__)[-1]
        reason = f"{self._what(error)} ({place.filename}:{place.lineno}, in {moment})"
        self.figures[name].state, self.figures[name].reason = "failed", reason
        self.log.named(name).exception(f"failed in {moment}", error)
        raise Failure(f"{name}: {reason}") from error

    def _what(self, error: BaseException) -> str:
        limit = self._plan.memory_limit_mb(self._assignment.host)
        over = f"more memory than its memory_limit_mb of {limit:g}" if limit and isinstance(error, MemoryError) else ""
        return f"{type(error).__name__}: {over}" if over else told(error)

    def _report(self) -> None:
        self._report_us = monotonic_us() + (READY_REPORT_MS * 1000 if self._answered[0] == 0 else REPORT_US)
        actual = actual_t()
        actual.run, actual.host, actual.incarnation = (
            self._assignment.run,
            self._assignment.host,
            self._assignment.incarnation,
        )
        actual.components = [figures.message() for figures in self.figures.values()]
        actual.times = [figures.histogram() for figures in self.figures.values()]
        actual.n = len(actual.components)
        for component in actual.components:
            if component.name in self._runners:
                component.lost = sum(image.lost for image in self._runners[component.name].images)
        first = actual.components[0]
        first.lost += self.inputs.lost
        first.fetched, first.strangers = self.inputs.fetched, self._complaints.total
        self._sender.publish(b"fwk/actual", actual.encode(), self._ports.sync)
        for runner in self._runners.values():
            runner.log.tell_dropped()

    def _send_log(self, line: log_t) -> None:
        self._sender.publish(b"fwk/log", line.encode(), self._ports.log)
