"""The host participant: answers each tick with one iteration of each of its components and one done."""

import struct
from collections.abc import Sequence

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.receiver import Complaints, Receiver
from fwk.bus.sender import NEVER_US, Sender
from fwk.clock import US_PER_S, Clock
from fwk.component.log import Logger
from fwk.engine.assignment import Assignment
from fwk.engine.catch_up import CatchUp
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.component_group import ComponentGroup, Ran, Written
from fwk.engine.failures import ComponentFailedError
from fwk.engine.lookahead import lookahead
from fwk.host.dynamic_channels import DynamicChannels
from fwk.host.hooks import ProcessHooks
from fwk.host.inputs import Inputs
from fwk.host.outputs import Outputs
from fwk.host.shutdown import LOCKSTEP_TIMEOUT_US, TIMEOUT_US, Shutdown
from fwk.lcm.messages import MessageError
from fwk.model.plan import NOBODY, Plan
from fwk.model.ports import Ports
from fwk.model.requests import clear_requests, has_requests, lost_message
from lcmtypes.core import actual_t, done_t, fetch_t, gone_t, leaving_t, log_t, protocol_t, tick_t

READY_REPORT_US = 100_000
"""Interval of the reports that a host is ready, until its first tick comes."""
REPORT_US = US_PER_S
TICK_AWAITED_US = 250_000
"""A report that is due waits so long for the end of a stage: after it the host is awake anyway, its memory warm."""


class Host:
    """Takes its components from `init` to `finalize`; `serve` is the participant."""

    def __init__(self, assignment: Assignment, network: Network, hooks: ProcessHooks) -> None:
        plan = assignment.plan
        self._assignment = assignment
        self._plan = plan
        self._network = network
        self._now_us = network.now_us
        self._hooks = hooks
        self._stopping = hooks.stopping
        self._ports = Ports.of(plan)
        self._sync_port = self._ports.sync
        self._sender = Sender(self._ports.host(assignment.host), network)
        self._clock = Clock(plan.period_us)
        self.log = Logger(plan.hosts[assignment.host].name, self._clock, self._send_log)
        self.group = ComponentGroup(
            assignment,
            hooks.find_class,
            hooks.make_runner,
            network.now_us,
            hooks.lift_memory_limit,
            self.log,
            self._send_log,
        )
        self._complaints = Complaints(self.log)
        indices = {component.index for component in self.group.plans}
        written = {channel.name: channel for channel in plan.channels if channel.writer in indices}
        read = [channel for channel in plan.channels if not indices.isdisjoint(channel.readers)]
        local = [channel for channel in read if channel.name in written]
        self.inputs = Inputs(
            plan,
            read,
            local,
            assignment.host,
            assignment.run,
            network,
            self._sender,
            self._complaints,
            restarted=assignment.start.incarnation > 1,
        )
        self._outputs = Outputs(
            written, self._ports, self._sender, self.inputs.local, assignment.start.sequences, network.now_us
        )
        self._dynamic: DynamicChannels | None = None
        if table := self.group.table:
            self._dynamic = DynamicChannels(plan, assignment.host, self.group, table, self.inputs, self._outputs)
        self._own = Receiver(self._sender.socket, self._ports.members, "of this run", "fwk/fetch", self._complaints)
        self._ticks: dict[int, tuple[int, Receiver]] = {}  # by descriptor: stage, receiver of its ticks
        stages = {stage for component in self.group.plans for stage in component.stages}
        for stage in sorted(stages.union(assignment.further_stages)):
            source = network.group_socket(self._ports.stage(stage))
            receiver = Receiver(source, (self._ports.supervisor,), "the supervisor's", "fwk/tick", self._complaints)
            self._ticks[source.fileno()] = stage, receiver
        network.watch(self._own)
        for _, receiver in self._ticks.values():
            network.watch(receiver)
        self._names_of_stage = [
            [component.name for component in self.group.plans if stage in component.stages]
            for stage in range(len(plan.stages))
        ]
        self._stages_ahead = _stages_ahead(plan, assignment.host) if hooks.runs_ahead else {}
        self._catch_up = CatchUp(assignment.start.incarnation)
        self._answered = (0, -1)  # the newest (tick, step) that was answered
        self._done = b""
        self._dones: dict[int, bytes] = {}  # dones of the newest tick, by step
        self._failed: ComponentFailedError | None = None  # in a stage run ahead, whose tick has not come yet
        self._ticks_ignored = False
        self._shutdown: Shutdown | None = None
        self._message = done_t()  # the next done; fields that stay the same are written once
        self._message.run, self._message.host = assignment.run, assignment.host
        self._message.incarnation = assignment.start.incarnation
        self._report_us = self._report_wake_us = 0

    def current_log(self) -> Logger:
        """Returns the log of the component that is being executed; while none is, the host's own."""
        return self.group.current_log() or self.log

    def serve(self) -> Steps[None]:
        """Initialises the components, answers ticks until the process is asked to stop, finalizes the components.

        Raises:
            ComponentFailedError: a component raised.
        """
        try:
            yield from self._live()
        except ComponentFailedError:
            yield from self._leave(())  # its messages of earlier iterations count
            raise
        finally:
            self._report()
            for runner in self.group.runners.values():
                runner.log._report_dropped(at_the_end=True)

    def _live(self) -> Steps[None]:
        try:
            self._init()
            yield from self._work()
            if self._failed:
                raise self._failed
            yield from self._finalize()
        except MemoryError as error:  # between two iterations
            self.group.out_of_memory(error)

    def _init(self) -> None:
        self.group.init(self._report)
        self._hooks.initialized()
        self._report()

    def _work(self) -> Steps[None]:
        """Answers ticks and fetches until the process is asked to stop."""
        own, stopping, now_us = self._own.fileno(), self._stopping, self._now_us
        while not stopping():
            for descriptor in (yield min(self._report_wake_us, self._sender.due_us)):
                if descriptor == own:
                    self._handle_own()
                elif descriptor in self._ticks:
                    stage, receiver = self._ticks[descriptor]
                    tick = self._receive_tick(receiver)
                    if tick:
                        yield from self._answer(tick, stage)
            if self._sender.due_us < NEVER_US:
                self._sender.send_due()
            if now_us() >= self._report_us:
                self._report()

    def _finalize(self) -> Steps[None]:
        """Finalizes the components and sends what they wrote with a final done, which counts if the run goes on."""
        written, tick = self.group.finalize()
        before = list(self._dones.values())
        done = self._message
        clear_requests(done)
        done.kind, done.tick, done.step, done.iteration = done_t.FINAL, tick, -1, 0
        self.group.put_lost_frames(done)
        self._publish(written, -1, 0)
        yield from self._leave([*before, self._done])

    def _leave(self, dones: Sequence[bytes]) -> Steps[None]:
        """Waits until no other process needs this one any more; `dones` are the last ones for the supervisor."""
        sent = self._outputs.sent
        if not dones and not sent:
            return
        self._ignore_ticks(True)
        leaving = leaving_t()
        leaving.run, leaving.host = self._message.run, self._message.host
        leaving.incarnation, leaving.tick = self._message.incarnation, self._message.tick
        leaving.n_marks, leaving.channel, leaving.sequence = len(sent), list(sent), list(sent.values())
        timeout_us = TIMEOUT_US if self._plan.clock == "wall" else LOCKSTEP_TIMEOUT_US
        self._shutdown = Shutdown(self._network, self._ports, self._sender, leaving, dones, timeout_us)
        yield from self._shutdown.wait(self._handle_own)

    def _receive_tick(self, receiver: Receiver) -> tick_t | None:
        message = receiver.receive()
        if message is None:
            return None
        try:
            tick: tick_t = sync.decode_tick(message[1])
        except MessageError as error:
            receiver.refuse(str(error))
            return None
        if tick.version != protocol_t.VERSION:
            receiver.refuse(f"protocol version {tick.version}, this host has {protocol_t.VERSION}")
            return None
        return tick if tick.run == self._assignment.run else None

    def _ignore_ticks(self, ignored: bool) -> None:
        """Leaves ticks in their sockets; otherwise repeated ticks would end every wait at once."""
        if ignored is self._ticks_ignored:
            return
        self._ticks_ignored = ignored
        for _, receiver in self._ticks.values():
            (self._network.unwatch if ignored else self._network.watch)(receiver)

    def _answer(self, tick: tick_t, stage: int) -> Steps[None]:
        """Runs the iterations of a tick, once; repeats the done for a tick that was answered before."""
        if self._assignment.host in tick.absent:
            return
        if (tick.tick, tick.step) <= self._answered:
            if tick.tick == self._answered[0] and tick.step in self._dones:
                self._sender.publish(sync.DONE, self._dones[tick.step], self._sync_port)
            return
        if self._failed:
            raise self._failed
        self._clock.tick, self._clock.now_us = tick.tick, tick.time_us
        new = self._dynamic.take_over(tick.channels) if self._dynamic and tick.channels else ()
        moved = self.inputs.advance(tick.channel, tick.sequence, tick.voids)
        for buffer in new:
            buffer.keep_newest()
        if self._catch_up.applies(tick.tick):
            self.inputs.keep_newest()
        lacking = self.inputs.collect(moved)
        if lacking and not (yield from self._fetch(lacking)):
            return
        if self._answered[0] == 0:
            self.inputs.forget_predecessor()
        self.group.deliver(moved)
        if tick.settings or tick.channels:
            self.group.configure(tick.settings, tick.channels)
        self.group.set_holder(tick.main_loop)
        if tick.tick != self._answered[0]:
            self._dones.clear()
        self._run_stage(tick, tick.step, stage)
        if stage in self._stages_ahead and tick.main_loop == NOBODY:
            self._run_ahead(tick, self._stages_ahead[stage])

    def _run_ahead(self, tick: tick_t, stages: Sequence[int]) -> None:
        """Runs further stages of a tick on the same marks of other hosts and the new marks of this one.

        A component that raises ends the process only when the tick of its stage comes: by then the dones of the stages
        before have been taken.
        """
        done = self._message
        for stage in stages:
            if self._stopping():
                break
            self.group.deliver(self.inputs.advance(done.channel, done.sequence, ()))
            try:
                self._run_stage(tick, stage, stage)
            except ComponentFailedError as error:
                self._failed = error
                break

    def _run_stage(self, tick: tick_t, step: int, stage: int) -> None:
        """Runs the iterations of a stage; sends what they wrote, and the done."""
        names = self._names_of_stage[stage]
        done = self._message
        done.kind, done.tick, done.step, done.iteration = done_t.STAGE, tick.tick, step, 0
        self._finish(names, self.group.run(names, self._plan.stages[stage], tick, step))
        self._sender.publish(sync.DONE, self._done, self._sync_port)
        self._catch_up.took_part(tick.tick)
        self._answered = tick.tick, step

    def _fetch(self, lacking: Sequence[ChannelBuffer]) -> Steps[bool]:
        """Fetches until everything visible is here; returns False if the process is asked to stop."""
        self._ignore_ticks(True)
        complete = yield from self.inputs.fetch(lacking, self._handle_own)
        self._ignore_ticks(False)
        return complete

    def _finish(self, names: Sequence[str], ran: Ran) -> None:
        """Sends what these components wrote; makes the done with their requests and the messages that were lost."""
        done = self._message
        if has_requests(done):
            clear_requests(done)
        self.group.put_requests(names, done)
        if self.inputs.lost:
            done.lost = [lost_message(channel, sequence) for channel, sequence in self.inputs.new_losses()]
        self._publish(*ran)

    def _publish(self, written: Written, next_us: int, busy_us: int) -> None:
        marks = self._outputs.publish(written)
        done = self._message
        done.next_time_us, done.busy_us = next_us, busy_us
        done.channel, done.sequence = list(marks), list(marks.values())
        self._done = self._dones[done.step] = sync.encode_done(done)

    def _handle_own(self) -> bool:
        """Handles messages to this host alone; returns False when it is time to stop."""
        while message := self._own.receive():
            try:
                self._handle_message(message[0], message[1])
            except (MessageError, ValueError, struct.error) as error:
                self._own.refuse(str(error))
        return not self._stopping()

    def _handle_message(self, channel: bytes, data: bytes) -> None:
        if channel == b"fwk/fetch":
            fetch = fetch_t.decode(data)
            if fetch.run == self._assignment.run:
                self._outputs.answer(fetch)
        elif channel == sync.TAKEN and self._shutdown:
            self._shutdown.answered(sync.decode_taken(data))
        elif channel == b"fwk/gone":
            gone = gone_t.decode(data)
            if gone.run == self._assignment.run:
                self._give_up(gone)
        else:
            raise MessageError("neither fetch nor gone")

    def _give_up(self, gone: gone_t) -> None:
        lost = self.inputs.gone(gone)
        if lost:
            channel = self.inputs.buffer(gone.channel).plan.name
            numbers = f"{gone.first_sequence} to {gone.last_sequence}"
            self.log.warning(f"{channel}: {lost} messages of {numbers} lost: their writer no longer has them")

    def _report(self) -> None:
        """Sends the states and figures of all components."""
        ticks = self._answered[0] > 0
        self._report_us = self._now_us() + (REPORT_US if ticks else READY_REPORT_US)
        self._report_wake_us = self._report_us + (TICK_AWAITED_US if ticks else 0)
        if self._hooks.reports:
            self._report_actual()
        for runner in self.group.runners.values():
            runner.log._report_dropped()

    def _report_actual(self) -> None:
        runners, metrics = self.group.runners, self.group.metrics.values()
        actual = actual_t()
        actual.run, actual.host = self._assignment.run, self._assignment.host
        actual.incarnation = self._assignment.start.incarnation
        actual.components = [each.message() for each in metrics]
        actual.times = [each.histogram() for each in metrics]
        for component in actual.components:
            if component.name in runners:
                component.lost_frames = sum(image.lost for image in runners[component.name].images.values())
        counters = actual.counters
        counters.fetched, counters.lost = self.inputs.fetched, self.inputs.lost
        counters.foreign = self._complaints.total
        self._sender.publish(sync.ACTUAL, sync.encode_actual(actual), self._sync_port)

    def _send_log(self, line: log_t) -> None:
        if not line.tick:
            line.tick, line.time_us = self._assignment.start.tick, self._assignment.start.time_us
        self._sender.publish(b"fwk/log", line.encode(), self._ports.log)


def _stages_ahead(plan: Plan, host: int) -> dict[int, list[int]]:
    """Returns the stages that a host runs on the marks of an earlier one, by that stage."""
    last = lookahead(plan)[host]
    return {stage: [each for each in last if stage < each <= last[stage]] for stage in last if last[stage] > stage}
