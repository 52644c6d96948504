"""The host process: answers each tick with one iteration of each of its components and one done."""

import json
import select
import socket
import struct
from collections.abc import Callable, Sequence

from fwk.bus import sync
from fwk.bus.complaints import Complaints
from fwk.bus.sockets import Sender, multicast_receiver, port_of, told
from fwk.clock import US_PER_S, Clock, monotonic_us
from fwk.component.log import Logger
from fwk.engine.runner import Runner, is_new
from fwk.host.assignment import Assignment
from fwk.host.component_group import Members
from fwk.host.dynamic_channels import Opened
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.host.process import give_memory_back
from fwk.host.shutdown import Leaving
from fwk.lcm import wire
from fwk.lcm.messages import MessageError
from fwk.model.ports import Ports
from lcmtypes.core import actual_t, done_t, fetch_t, gone_t, log_t, tick_t

READY_REPORT_MS = 100  # how often a host says that it is ready until its first tick comes
REPORT_US = US_PER_S


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
        self._ports = Ports.of(plan)
        self._supervisor_port, self._sync_port = self._ports.supervisor, self._ports.sync
        self._sender = Sender(self._ports.host(assignment.host))
        self._clock = Clock(plan.period_us)
        self.log = Logger(plan.hosts[assignment.host].name, self._clock, self._send_log)
        self._members = Members(assignment, make_runner, self.log, self._send_log)
        self._complaints = Complaints(self.log)
        indices = {component.index for component in self._members.plans}
        written = {channel.name: channel for channel in plan.channels if channel.writer in indices}
        read = [channel for channel in plan.channels if not indices.isdisjoint(channel.readers)]
        local = [channel for channel in read if channel.name in written]
        self.inputs = Inputs(
            plan,
            read,
            local,
            assignment.host,
            assignment.run,
            self._sender,
            self._complaints,
            restarted=assignment.start.incarnation > 1,
        )
        self._outputs = Outputs(written, self._ports, self._sender, self.inputs.local, assignment.start.sequences)
        self._opened: Opened | None = None
        if instances := self._members.instances:
            self._opened = Opened(plan, assignment.host, self._members, instances, self.inputs, self._outputs)
        stages = sorted({stage for component in self._members.plans for stage in component.stages})
        listening = [(stage, multicast_receiver(self._ports.stage(stage))) for stage in stages]
        self._sockets = {source.fileno(): (stage, source) for stage, source in listening}
        self._assembler = wire.Assembler()
        self._poller = select.epoll()  # unlike poll() it does not look at every socket again each time
        for descriptor in (*self._sockets, self._sender.socket.fileno(), wakeup):
            self._poller.register(descriptor, select.EPOLLIN)
        self._takes_part = [
            [component.name for component in self._members.plans if stage in component.stages]
            for stage in range(len(plan.stages))
        ]
        self._answered = (0, -1)  # the newest (tick, stage) done
        self._done = b""
        self._leaving: Leaving | None = None
        self._message = done_t()  # the next done; what stays the same in it is written once
        self._message.run, self._message.host = assignment.run, assignment.host
        self._message.incarnation = assignment.start.incarnation
        self._report_us = 0

    def log_of_now(self) -> Logger:
        """That of the component that works now; while none does, the process's own."""
        return self._members.log_of_now() or self.log

    def serve(self) -> None:
        """Initialises the components, answers ticks until it is told to stop, finalizes the components.

        Raises:
            Failure: a component raised.
        """
        try:
            self._init()
            while not self._stopping():
                self._turn()
                if monotonic_us() >= self._report_us:
                    self._report()
            self._finalize()
        except MemoryError as error:  # between two iterations
            self._members.out_of_memory(error)
        finally:
            self._report()
            for runner in self._members.runners.values():
                runner.log.tell_dropped(at_the_end=True)

    def _init(self) -> None:
        self._members.init(self._report)
        give_memory_back()
        self._report()

    def _turn(self) -> None:
        """Waits for something to do, and does it."""
        for descriptor, _ in self._poller.poll(0.001 * READY_REPORT_MS if self._answered[0] == 0 else 1):
            source = self._sockets.get(descriptor)
            tick = self._receive_tick(source[1]) if source else None
            if source and tick:
                self._answer(tick, source[0])
            elif not source:
                self._handle_own()

    def _finalize(self) -> None:
        """Finalizes the components and sends what they wrote, with a last done: it counts if the run goes on."""
        written, tick = self._members.finalize()
        before = self._done
        self._publish(written, tick, done_t.FINAL, -1, 0, self._members.missed_frames())
        self._leaving = Leaving(self._ports, self._sender, before, self._message, self._outputs.sent)
        self._leaving.wait(self._handle_own)

    def _receive_tick(self, source: socket.socket) -> tick_t | None:
        try:
            datagram, address = source.recvfrom(wire.DATAGRAM_MAX)
        except BlockingIOError:
            return None
        try:
            if port_of(address) != self._supervisor_port:
                raise MessageError(f"datagram from {told(address)}, which is not the supervisor's")
            message = self._assembler.feed(datagram, address[1])
            tick: tick_t | None = sync.decode_tick(message[1]) if message else None
        except MessageError as error:
            self._complaints("fwk/tick", f"{error}; refused")
            return None
        return tick if tick and tick.run == self._assignment.run else None

    def _answer(self, tick: tick_t, stage: int) -> None:
        if self._assignment.host in tick.absent:
            return
        this = (tick.tick, tick.stage)
        if this <= self._answered:
            if this == self._answered:
                self._sender.publish(sync.DONE, self._done, self._ports.sync)
            return
        self._clock.tick, self._clock.now_us = tick.tick, tick.time_us
        new = self._opened.take_over(tick.changes) if self._opened and tick.changes else ()
        moved = self.inputs.advance(tick.channel, tick.sequence, tick.voids)
        for box in new:
            box.skip_to(box.mark - 1)
        if is_new(tick.tick, self._answered[0]):
            self.inputs.newest_only()
        if not self.inputs.wait(moved, self._handle_own):
            return
        if self._answered[0] == 0:
            self.inputs.forget_predecessor()
        self._members.deliver(moved)
        if tick.changes:
            self._members.configure(tick.changes)
        self._members.tell_holder(tick.main_loop)
        names = self._takes_part[stage]
        self._finish(tick, names, *self._members.run(names, self._plan.stages[stage], tick))
        self._answered = this

    def _finish(
        self, tick: tick_t, names: Sequence[str], written: list[tuple[str, bytes]], next_us: int, busy_us: int
    ) -> None:
        """Sends what these components wrote, and the done."""
        wishes = self._members.wishes(names)
        if self.inputs.lost:
            wishes = self._with_missed(wishes)
        self._publish(written, tick.tick, tick.stage, next_us, busy_us, wishes)

    def _with_missed(self, wishes: str) -> str:
        """The recording says what this host never saw, so that a replay keeps it from its components, too."""
        missed = self.inputs.missed()
        return json.dumps({**json.loads(wishes or "{}"), "missed": missed}) if missed else wishes

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
        elif channel == sync.DONE and self._leaving:
            self._leaving.heard(sync.decode_done(data))
        elif channel == b"fwk/gone":
            gone = gone_t.decode(data)
            if gone.run == self._assignment.run:
                self._give_up(gone)
        else:
            raise MessageError("neither fetch nor gone")

    def _give_up(self, gone: gone_t) -> None:
        lost = self.inputs.gone(gone)
        if lost:
            channel = self.inputs.box(gone.channel).plan.name
            numbers = f"{gone.first_sequence} to {gone.last_sequence}"
            self.log.warning(f"{channel}: {lost} messages of {numbers} lost: their writer no longer has them")

    def _report(self) -> None:
        self._report_us = monotonic_us() + (READY_REPORT_MS * 1000 if self._answered[0] == 0 else REPORT_US)
        runners, figures = self._members.runners, self._members.figures.values()
        actual = actual_t()
        actual.run, actual.host = self._assignment.run, self._assignment.host
        actual.incarnation = self._assignment.start.incarnation
        actual.components = [each.message() for each in figures]
        actual.times = [each.histogram() for each in figures]
        actual.n = len(actual.components)
        for component in actual.components:
            if component.name in runners:
                component.lost = sum(image.lost for image in runners[component.name].images.values())
        first = actual.components[0]
        first.lost += self.inputs.lost
        first.fetched, first.strangers = self.inputs.fetched, self._complaints.total
        self._sender.publish(b"fwk/actual", actual.encode(), self._ports.sync)
        for runner in runners.values():
            runner.log.tell_dropped()

    def _send_log(self, line: log_t) -> None:
        if not line.tick:
            line.tick, line.time_us = self._assignment.start.tick, self._assignment.start.time_us
        self._sender.publish(b"fwk/log", line.encode(), self._ports.log)
