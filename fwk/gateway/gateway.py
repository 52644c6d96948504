"""Follows the main loop by its tick records, collects each tick's messages and passes them on in one fixed order."""

import struct
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.receiver import Complaints, Receiver
from fwk.bus.sender import Sender
from fwk.clock import Clock
from fwk.component.log import Logger, is_plausible
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.gateway.connections import Outsiders, Sink, SupervisorConnection
from fwk.gateway.dynamic_channels import FollowedChannels
from fwk.gateway.fetch_server import FetchServer
from fwk.gateway.ingress import Ingress
from fwk.gateway.pacing import PacedPublisher
from fwk.gateway.record_queue import RecordQueue
from fwk.host.inputs import Inputs
from fwk.lcm import messages
from fwk.lcm.messages import Header, MessageError
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from lcmtypes.core import (
    done_t,
    fetch_t,
    gone_t,
    leaving_t,
    log_t,
    recorded_t,
    status_t,
    taken_t,
    tick_record_t,
)

HEARD_AT_ONCE = 256
"""Messages of other programs after which the messages of the run have their turn again."""
HANDED_AT_ONCE = 32
"""Messages that a sink gets before the public bus has its turn again."""
PATIENCE_US = 2_000_000
"""Longest wall time that the public bus waits for a busy listener."""
REAL_TIME_PATIENCE_US = 100_000
"""The same in real time, in which programs outside need the newest messages in time."""
FINISH_US = 20_000_000
"""Longest wall time after the end of the run in which the public bus gets what is left at its listeners' pace."""
FINISHING = b"fwk/finishing"
"""Packet that tells the supervisor that this work goes on."""
FINISHING_US = 500_000
"""Wall time between two such packets."""
IDLE_US = 100_000
"""Wall time without any event after which the supervisor may have lost a report."""


class Gateway:
    """Follows a run as a participant; `serve` ends when the supervisor has closed `control` and all is written."""

    def __init__(
        self, plan: Plan, run: int, network: Network, control: SupervisorConnection, public: Outsiders | None
    ) -> None:
        self.sinks: list[Sink] = []
        self.clock = Clock(plan.period_us)
        self.log = Logger("gateway", self.clock, self._log_line)
        self._plan = plan
        self._run = run
        self._control = control
        self._public = public
        self._network = network
        self._ports = ports = Ports.of(plan)
        self._sender = sender = Sender(ports.host(ports.gateway), network)
        self._complaints = complaints = Complaints(self.log)
        self._inputs = Inputs(plan, plan.channels, [], ports.gateway, run, network, sender, complaints)
        self.dynamic = FollowedChannels(plan, self._inputs)
        """The dynamic channels."""
        self._ingress = Ingress(plan, sender, self._inputs, self.clock, complaints)
        self._fetches = FetchServer(plan, self._inputs, self._ingress, sender, self._give_up)
        self._records = RecordQueue(plan, run, network, sender, complaints, self.dynamic, self._acknowledge)
        status = network.group_socket(ports.status)
        self._status = Receiver(status, (ports.supervisor,), "the supervisor's", "fwk/status", complaints)
        self._lines = Receiver(network.group_socket(ports.log), ports.members, "of this run", "fwk/log", complaints)
        self._own = Receiver(sender.socket, ports.members, "of this run", "fwk/fetch", complaints)
        self._open = True
        self._idle_us = 0
        self._handlers: dict[int, Callable[[], object]] = {
            self._own.fileno(): self._hear_hosts,
            control.fileno(): self._hear_supervisor,
            self._lines.fileno(): partial(self._pass_on, self._lines, log_t),
            self._status.fileno(): partial(self._pass_on, self._status, status_t),
        }
        if public:
            self._handlers[public.fileno()] = self._hear_outside
        for descriptor in (*self._handlers, self._records.receiver.fileno()):
            network.watch(descriptor)
        self._overrun: set[str] = set()  # listeners that were reported
        self.publisher = PacedPublisher(
            network.now_us,
            public.send if public else _drop,
            public.busy_listeners if public else _none,
            REAL_TIME_PATIENCE_US if plan.clock == "wall" else PATIENCE_US,
        )
        """Sends what goes to the public bus."""

    @property
    def lost(self) -> int:
        """Number of the run's messages that never arrived here."""
        return self._inputs.lost

    def watch(self, descriptor: int, handler: Callable[[], object]) -> None:
        """Calls `handler`, which must not wait, whenever `descriptor` is readable."""
        self._network.watch(descriptor)
        self._handlers[descriptor] = handler

    def serve(self) -> Steps[None]:
        """Reports that it receives everything from now on, and works until the supervisor closes the connection."""
        self._acknowledge()
        while self._open:
            ready = yield self._wake_us()
            self._send_due()
            for descriptor in ready:
                if handle := self._handlers.get(descriptor):
                    handle()
            if ready:
                yield from self._receive_records()
                self._idle_us = self._network.now_us() + IDLE_US
            elif self._network.now_us() >= self._idle_us:
                self._idle()
            self._records.request_missing()
        yield from self._finish()

    def take_in(self, channel: str, message: Any) -> int:
        """Makes a message from outside one of the run, visible from one of the next ticks on; returns its number.

        Raises:
            IngressFullError: too many wait for the next tick.
            MessageError: it cannot be encoded.
        """
        sequence = self._ingress.take_in(channel, message)
        self._acknowledge()
        return sequence

    def _idle(self) -> None:
        """Repeats the last report if the supervisor may lack it."""
        self._idle_us = self._network.now_us() + IDLE_US
        if self._ingress.marks or self._records.next == 1:
            self._acknowledge()

    def _wake_us(self) -> int:
        return min(self._idle_us, self._records.due_us, self._sender.due_us, self.publisher.due_us)

    def _send_due(self) -> None:
        """Sends delayed data: fragments, messages for the public bus, a request for missing records."""
        self._sender.send_due()
        self._publish_due()

    def _publish_due(self) -> None:
        self.publisher.send_due()
        if (overrun := self.publisher.overrun) and overrun not in self._overrun:
            self._overrun.add(overrun)
            self.log.warning(f"public bus: {overrun} does not keep up; it may lack messages")

    def _finish(self) -> Steps[None]:
        """Writes the remaining data and closes everything."""
        self._pass_on(self._lines, log_t)
        self._pass_on(self._status, status_t)
        yield from self._publish_rest()
        for sink in self.sinks:
            sink.close()
        self._inputs.close()
        for receiver in (self._records.receiver, self._lines, self._status, self._own):
            receiver.socket.close()

    def _publish_rest(self) -> Steps[None]:
        """Sends what waits for the public bus, at the pace of its listeners, as long as the supervisor lets it."""
        for descriptor in (*self._handlers, self._records.receiver.fileno()):
            self._network.unwatch(descriptor)
        now_us = report_us = self._network.now_us()
        end_us = now_us + FINISH_US
        while self.publisher.waiting:
            if now_us >= report_us:
                report_us = now_us + FINISHING_US
                with suppress(OSError):  # the supervisor has died
                    self._control.send(FINISHING)
            yield self.publisher.due_us
            now_us = self._network.now_us()
            if now_us >= end_us:
                self.publisher.send_all()
            self._publish_due()

    def _receive_records(self) -> Steps[None]:
        self._records.receive()
        while next_record := self._records.take():
            if not (yield from self._take(*next_record)):
                return
            self._records.taken()

    def _take(self, record: tick_record_t, recorded: bytes) -> Steps[bool]:
        """Passes a tick on to the sinks; returns False if the supervisor closed the connection."""
        self.clock.tick, self.clock.now_us = record.tick, record.time_us
        for change in record.channels:
            self.dynamic.apply(change)
        moved = self._inputs.advance(record.channel, record.sequence, record.voids)
        lacking = self._inputs.collect(moved)
        if lacking and not (yield from self._fetch(lacking)):
            return False
        collected = []
        for buffer in moved:
            index, name = buffer.plan.index, buffer.plan.name
            arrived = [(Header.of(data), data) for data in buffer.take()]
            if arrived:
                self._fetches.keep(index, record.tick, arrived)
                collected += [
                    (header.tick, header.stage, index, header.sequence, name, data) for header, data in arrived
                ]
        self._ingress.recorded(record)
        collected.sort()
        for sink in self.sinks:
            for first in range(0, len(collected), HANDED_AT_ONCE):
                for *_, channel, data in collected[first : first + HANDED_AT_ONCE]:
                    sink.message(channel, data, record.time_us)
                self.publisher.send_due()
            sink.message("fwk/record", recorded, record.time_us)
            sink.tick()
        return True

    def _fetch(self, lacking: Sequence[ChannelBuffer]) -> Steps[bool]:
        """Fetches visible messages that are missing; during the wait only hosts and the supervisor are served."""
        descriptors = (*self._handlers, self._records.receiver.fileno())
        others = [each for each in descriptors if each not in (self._own.fileno(), self._control.fileno())]
        for descriptor in others:
            self._network.unwatch(descriptor)
        complete = yield from self._inputs.fetch(lacking, self._still_open)
        for descriptor in others:
            self._network.watch(descriptor)
        return complete

    def _still_open(self) -> bool:
        self._hear_hosts()
        self._hear_supervisor()
        return self._open

    def _acknowledge(self) -> None:
        """Reports to the supervisor the newest recorded tick, the channels received, and the messages from outside."""
        recorded = recorded_t()
        recorded.run, recorded.tick, recorded.change = self._run, self._records.next - 1, self.dynamic.announced
        marks = self._ingress.marks
        recorded.channel, recorded.sequence = list(marks), list(marks.values())
        self._sender.publish(sync.RECORDED, sync.encode_recorded(recorded), self._ports.sync)

    def _pass_on(self, receiver: Receiver, kind: type) -> None:
        for channel, data in receiver.messages(receiver.topic.encode()):
            try:
                message = messages.decode(kind, data, receiver.topic)  # the sinks rely on that
                if kind is log_t and not is_plausible(message):
                    raise MessageError("log line of an impossible time or level")
            except MessageError as error:
                receiver.refuse(str(error))
            else:
                self._emit(channel.decode(), data)

    def _log_line(self, line: log_t) -> None:
        self._emit("fwk/log", line.encode())

    def _emit(self, channel: str, data: bytes) -> None:
        for sink in self.sinks:
            sink.message(channel, data, self.clock.now_us)

    def _hear_outside(self) -> bool:
        """Takes messages from the public bus, a limited number at once; returns whether there may be more."""
        before, heard = self._ingress.marks, 0
        while self._public and heard < HEARD_AT_ONCE:
            heard += 1
            try:
                message = self._public.receive()
            except MessageError as error:
                self._complaints("public bus", f"{error}; refused")
                continue
            if message is None:
                break
            self._ingress.hear(*message)
        if self._ingress.marks != before:
            self._acknowledge()
        return heard > 1

    def _hear_supervisor(self) -> None:
        """Notes that the supervisor has closed the connection."""
        try:
            self._open = bool(self._control.recv(1)) and self._open
        except BlockingIOError:
            pass
        except OSError:
            self._open = False

    def _hear_hosts(self) -> None:
        """Answers messages of hosts to the gateway alone."""
        for channel, data in self._own.messages(b"fwk/gone", sync.LEAVING, b"fwk/fetch"):
            try:
                if channel == sync.LEAVING:
                    self._release(sync.decode_leaving(data))
                elif channel == b"fwk/fetch" and (fetch := fetch_t.decode(data)).run == self._run:
                    self._fetches.answer(fetch)
                elif channel == b"fwk/gone" and (gone := gone_t.decode(data)).run == self._run:
                    self._give_up(gone)
            except (MessageError, ValueError, struct.error) as error:
                self._own.refuse(str(error))

    def _release(self, leaving: leaving_t) -> None:
        """Answers a leaving host as soon as all of its messages are here; the host repeats itself until then."""
        if leaving.run != self._run or not 0 <= leaving.host < len(self._plan.hosts):
            return
        marks = [pair for pair in zip(leaving.channel, leaving.sequence, strict=True) if pair[0] in self._inputs]
        if self._inputs.have(marks, leaving.host):
            taken = taken_t()
            taken.run, taken.taker, taken.incarnation = self._run, self._ports.gateway, leaving.incarnation
            taken.kind, taken.tick = done_t.FINAL, leaving.tick
            self._sender.send(sync.TAKEN, taken.encode(), self._ports.host(leaving.host))

    def _give_up(self, gone: gone_t) -> None:
        lost = self._inputs.gone(gone)
        if lost:
            channel = self._inputs.buffer(gone.channel).plan.name
            numbers = f"{gone.first_sequence} to {gone.last_sequence}"
            self.log.error(f"{channel}: {lost} messages of {numbers} are lost and not in the recording")


def _drop(_: bytes) -> None:
    """Sends nothing: the run has no public bus."""


def _none() -> None:
    """Names no listener: the run has no public bus."""
