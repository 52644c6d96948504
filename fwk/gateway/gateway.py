"""Follows the main loop by its tick records, collects each tick's messages and hands them on in one fixed order."""

import struct
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from fwk.bus import sync
from fwk.bus.complaints import Complaints
from fwk.bus.network import DatagramSocket, Network, Steps
from fwk.bus.sender import Sender
from fwk.bus.sockets import port_of, told
from fwk.bus.waiting import Source
from fwk.clock import Clock
from fwk.component.log import Logger
from fwk.engine.catch_up import AWAY_TICKS
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.engine.message_history import gaps
from fwk.gateway.connections import Outsiders, Sink, SupervisorConnection
from fwk.gateway.ingress import Outside
from fwk.gateway.ingress_filter import IngressFilter
from fwk.gateway.pacing import PacedPublisher
from fwk.host.inputs import Inputs
from fwk.lcm import envelope, wire
from fwk.lcm.messages import Header, MessageError
from fwk.model.channel_table import ChannelTable, Fact, facts_in
from fwk.model.names import LINES
from fwk.model.plan import NOBODY, ChannelPlan, Plan
from fwk.model.ports import Ports
from lcmtypes.core import (
    announcement_t,
    channels_change_t,
    done_t,
    fetch_records_t,
    fetch_t,
    gone_t,
    leaving_t,
    log_t,
    protocol_t,
    recorded_t,
    taken_t,
    tick_record_t,
)

HEARD_AT_ONCE = 256  # messages of other programs, before the run's own have their turn again
IDLE_US = 100_000
"""Wall time without any event after which the supervisor may have lost what it was told."""


class Gateway:
    """Collects, as a participant; `serve` ends when the supervisor has closed `control` and everything is written."""

    def __init__(
        self, plan: Plan, run: int, network: Network, control: SupervisorConnection, public: Outsiders | None
    ) -> None:
        self.sinks: list[Sink] = []
        self.instances = ChannelTable(plan)
        """Which channels there are, those too that were opened while the run goes on."""
        self.opened_plain: set[str] = set()
        """Channels that were opened with a type without our header."""
        self._plan = plan
        self._run = run
        self._control = control
        self._public = public
        self._ports = Ports.of(plan)
        self._network = network
        self._sender = Sender(self._ports.host(self._ports.gateway), network)
        self.clock = Clock(plan.period_us)
        self.log = Logger("gateway", self.clock, self._log_line)
        self._complaints = Complaints(self.log)
        self._inputs = Inputs(
            plan, plan.channels, [], self._ports.gateway, run, network, self._sender, self._complaints
        )
        opened = [each for each in plan.channels if each.of_tools or each.name in plan.outside or each.name == LINES]
        self._outside = Outside(opened, self._ports, self._sender, self._inputs, self.clock)
        self._strangers = IngressFilter(plan, self.take_in, self._complaints)
        self._records = network.group_socket(self._ports.record)
        self._lines = network.group_socket(self._ports.log)
        self._status = network.group_socket(self._ports.status)
        # Of each channel the newest message and all of the last ticks that a reader may still want one of.
        self._kept_ticks = AWAY_TICKS if plan.clock == "wall" else 1
        self._recent: dict[int, list[tuple[int, int, bytes]]] = {}  # tick, sequence number, message
        self._waiting: dict[int, tuple[tick_record_t, bytes]] = {}
        self._next = 1  # tick whose record comes next
        self._announced = 0  # newest change of the blackboard that was announced
        self._open = True
        self._handlers: list[Callable[[], None]] = []
        self._assembler = wire.Assembler()
        self._sources: list[Source] = [self._records, self._lines, self._status]
        self._sources += [public] if public else []
        self.publisher = PacedPublisher(network.now_us, public.send if public else _drop)
        """Sends what goes to the public bus."""
        for source in (*self._sources, self._sender.socket, control):
            network.watch(source)

    @property
    def lost(self) -> int:
        """How many messages of the run never came here."""
        return self._inputs.lost

    def watch(self, descriptor: int, handler: Callable[[], None]) -> None:
        """Calls `handler`, which must not wait, whenever something happens, also when there is something to read."""
        self._network.watch(descriptor)
        self._sources.append(descriptor)
        self._handlers.append(handler)

    def serve(self) -> Steps[None]:
        """Says that it hears everything from now on, and works until the supervisor closes the control connection."""
        self._acknowledge()
        while self._open:
            happened = yield min(self._network.now_us() + IDLE_US, self._sender.due_us, self.publisher.due_us)
            self._sender.send_due()
            self.publisher.send_due()
            if not happened and (self._outside.marks or self._next == 1):
                self._acknowledge()  # the main loop may have lost what it was told
            self._handle_own()
            self._hear_strangers()
            self._receive_lines()
            yield from self._receive_records()
            for handle in self._handlers:
                handle()
            if self._next in self._waiting or not self._waiting:
                continue
            self._ask_for_records()
        self._receive_lines()
        for sink in self.sinks:
            sink.close()
        while self.publisher.waiting:
            yield self.publisher.due_us
            self.publisher.send_due()
        self._inputs.close()
        for source in (self._records, self._lines, self._status, self._sender.socket):
            source.close()

    def take_in(self, channel: str, message: Any) -> int:
        """Makes a message from outside one of the run, visible from one of the next ticks on; returns its number.

        Raises:
            Full: too many wait for the next tick.
            MessageError: it cannot be encoded.
        """
        sequence = self._outside.take_in(channel, message)
        self._acknowledge()
        return sequence

    def _receive_records(self) -> Steps[None]:
        for channel, data in self._drain(self._records, sync.RECORD, sync.ANNOUNCE):
            try:
                if channel == sync.ANNOUNCE:
                    self._hear_announcement(sync.decode_announcement(data))
                else:
                    self._hear_record(sync.decode_record(data), data)
            except (MessageError, ValueError) as error:
                self._complaints("fwk/record", f"{error}; refused")
        while self._next in self._waiting:
            record, data = self._waiting.pop(self._next)
            if not (yield from self._take(record, data)):
                return
            self._next += 1
            self._acknowledge()

    def _hear_announcement(self, announcement: announcement_t) -> None:
        if announcement.run == self._run:
            self._listen(facts_in(announcement.change))
            self._announced = announcement.change.number
            self._acknowledge()

    def _hear_record(self, record: tick_record_t, data: bytes) -> None:
        if record.run != self._run:
            return
        self._check(record)
        if record.tick >= self._next:
            self._waiting[record.tick] = (record, data)
        else:
            self._acknowledge()

    def _check(self, record: tick_record_t) -> None:
        """Raises ValueError or MessageError for a record that names what the plan does not have."""
        channels = len(self._plan.channels) + self._plan.spare_channels
        facts = [fact for change in record.channels for fact in facts_in(change)]
        named = [*record.channel, *(each.channel for each in record.voids)]
        named += [fact.opening.channel for fact in facts if fact.opening]
        if record.version != protocol_t.VERSION:
            raise MessageError(f"protocol version {record.version}, this gateway has {protocol_t.VERSION}")
        if any(not 0 <= channel < channels for channel in named):
            raise MessageError("a tick record with a channel that the plan does not have")
        if any(not 0 <= fact.component < len(self._plan.components) for fact in facts):
            raise MessageError("a tick record with a component that the plan does not have")

    def _take(self, record: tick_record_t, recorded: bytes) -> Steps[bool]:
        self.clock.tick, self.clock.now_us = record.tick, record.time_us
        for change in record.channels:
            self._open_channels(change)
        moved = self._inputs.advance(record.channel, record.sequence, record.voids)
        lacking = self._inputs.collect(moved)
        if lacking and not (yield from self._fetch(lacking)):
            return False
        collected = []
        for box in moved:
            arrived = box.take()
            if arrived:
                recent = self._recent.get(box.plan.index, [])
                since = record.tick - self._kept_ticks
                self._recent[box.plan.index] = [each for each in recent if each[0] >= since]
            for data in arrived:
                header = Header.of(data)
                self._recent[box.plan.index].append((header.tick, header.sequence, data))
                collected.append((header.tick, header.stage, box.plan.index, header.sequence, box.plan.name, data))
        self._outside.recorded(record)
        collected.sort()
        for sink in self.sinks:
            for *_, channel, data in collected:
                sink.message(channel, data, record.time_us)
            sink.message("fwk/record", recorded, record.time_us)
            sink.tick()
        return True

    def _fetch(self, lacking: Sequence[ChannelBuffer]) -> Steps[bool]:
        """Fetches what is visible and not here; all other sources would end every wait at once."""
        for source in self._sources:
            self._network.unwatch(source)
        complete = yield from self._inputs.fetch(lacking, self._handle_own)
        for source in self._sources:
            self._network.watch(source)
        return complete

    def _open_channels(self, change: channels_change_t) -> None:
        """What components opened at run time is collected as everything else."""
        facts = facts_in(change)
        self.instances.apply(facts)
        self._listen(facts)
        opened = [fact for fact in facts if fact.opening and fact.opening.channel >= len(self._plan.channels)]
        for component, kind, opening in ((fact.component, fact.kind, fact.opening) for fact in opened):
            assert opening
            self.opened_plain.discard(opening.name)
            if envelope.is_plain(opening.type_name):
                self.opened_plain.add(opening.name)
            if kind == "write":
                self._inputs.set_writer(opening.channel, self._plan.components[component].host)

    def _listen(self, facts: Iterable[Fact]) -> None:
        """To channels that were never open before."""
        for fact in facts:
            opening = fact.opening
            if opening and opening.channel not in self._inputs:
                self._inputs.open(ChannelPlan(opening.channel, opening.name, opening.type_name, NOBODY, ()))

    def _acknowledge(self) -> None:
        recorded = recorded_t()
        recorded.run, recorded.tick, recorded.change = self._run, self._next - 1, self._announced
        marks = self._outside.marks
        recorded.channel, recorded.sequence = list(marks), list(marks.values())
        self._sender.publish(sync.RECORDED, sync.encode_recorded(recorded), self._ports.sync)

    def _ask_for_records(self) -> None:
        fetch = fetch_records_t()
        fetch.run, fetch.first_tick, fetch.last_tick = self._run, self._next, min(self._waiting) - 1
        self._sender.send(sync.FETCH_RECORDS, fetch.encode(), self._ports.supervisor)

    def _receive_lines(self) -> None:
        for _, data in self._drain(self._lines, b"fwk/log", anybody=True):
            self._emit("fwk/log", data)
        for _, data in self._drain(self._status, b"fwk/status"):
            self._emit("fwk/status", data)

    def _log_line(self, line: log_t) -> None:
        self._emit("fwk/log", line.encode())

    def _emit(self, channel: str, data: bytes) -> None:
        for sink in self.sinks:
            sink.message(channel, data, self.clock.now_us)

    def _hear_strangers(self) -> bool:
        """Takes what waits on the public bus, but no more than a little at once; says whether there was something."""
        for number in range(HEARD_AT_ONCE if self._public else 0):
            try:
                heard = self._public.receive() if self._public else None
            except MessageError as error:
                self._complaints("public bus", f"{error}; refused")
                continue
            if heard is None:
                return number > 0
            self._strangers.hear(*heard)
        return self._public is not None

    def _handle_own(self) -> bool:
        while True:
            try:
                message = self._sender.receive(self._ports.members)
                if message is None:
                    break
                name, data = message
                if name == b"fwk/gone":
                    gone = gone_t.decode(data)
                    if gone.run == self._run:
                        self._give_up(gone)
                elif name == sync.LEAVING:
                    self._see_off(sync.decode_leaving(data))
                elif name == b"fwk/fetch":
                    fetch = fetch_t.decode(data)
                    if fetch.run == self._run and fetch.channel in self._inputs:
                        self._answer_for(fetch)
                else:
                    raise MessageError("neither gone, fetch nor leaving")
            except (MessageError, ValueError, struct.error) as error:
                self._complaints("fwk/fetch", f"{error}; refused")
        try:
            if not self._control.recv(1):
                self._open = False
        except BlockingIOError:
            pass
        except OSError:
            self._open = False
        return self._open

    def _see_off(self, leaving: leaving_t) -> None:
        """A host leaves as soon as everything that it has sent is here; it repeats itself until it is."""
        if leaving.run != self._run or not 0 <= leaving.host < len(self._plan.hosts):
            return
        marks = [pair for pair in zip(leaving.channel, leaving.sequence, strict=True) if pair[0] in self._inputs]
        if self._inputs.have(marks, leaving.host):
            taken = taken_t()
            taken.run, taken.taker, taken.incarnation = self._run, self._ports.gateway, leaving.incarnation
            taken.kind, taken.tick = done_t.FINAL, leaving.tick
            self._sender.send(sync.TAKEN, taken.encode(), self._ports.host(leaving.host))

    def _answer_for(self, fetch: fetch_t) -> None:
        """Answers in place of a writer that has left the run, or was started again and asked for what was before.

        Here are the newest message of each channel, all of the last two recorded ticks (in real time: 17), which nobody
        who reads all is further behind than, and all since. The answer is final: the tick that the reader takes part
        in, and with it the next record, may be waiting for it.
        """
        box = self._inputs.buffer(fetch.channel)
        found = self._outside.kept(fetch.channel, fetch.first_sequence, fetch.last_sequence)
        if found is None:
            recent = [(number, data) for _, number, data in self._recent.get(fetch.channel, [])]
            found = [each for each in recent if fetch.first_sequence <= each[0] <= fetch.last_sequence]
            found += box.held(fetch.first_sequence, fetch.last_sequence)
        for first, last in gaps((number for number, _ in found), fetch.first_sequence, fetch.last_sequence):
            self._tell_gone(fetch, first, last)
        for _, data in found if fetch.host != self._ports.gateway else ():
            self._sender.publish_paced(box.plan.name.encode(), data, self._ports.channel(fetch.channel))

    def _tell_gone(self, fetch: fetch_t, first: int, last: int) -> None:
        gone = gone_t()
        gone.run, gone.channel, gone.first_sequence, gone.last_sequence = fetch.run, fetch.channel, first, last
        if fetch.host == self._ports.gateway:
            self._give_up(gone)
        else:
            self._sender.send(b"fwk/gone", gone.encode(), self._ports.host(fetch.host))

    def _give_up(self, gone: gone_t) -> None:
        lost = self._inputs.gone(gone)
        if lost:
            channel = self._inputs.buffer(gone.channel).plan.name
            numbers = f"{gone.first_sequence} to {gone.last_sequence}"
            self.log.error(f"{channel}: {lost} messages of {numbers} are lost and not in the recording")

    def _drain(self, source: DatagramSocket, *channels: bytes, anybody: bool = False) -> list[tuple[bytes, bytes]]:
        found: list[tuple[bytes, bytes]] = []
        while True:
            try:
                datagram, address = source.recvfrom(wire.DATAGRAM_MAX)
            except OSError:  # no datagram
                return found
            try:
                known = self._ports.members if anybody else (self._ports.supervisor,)
                if port_of(address) not in known:
                    raise MessageError(f"datagram from {told(address)}, which is not of this run")
                message = self._assembler.feed(datagram, address[1])
                if message and message[0] not in channels:
                    raise MessageError("a message of another channel")
                found += [message] if message else []
            except MessageError as error:
                self._complaints(channels[0].decode(), f"{error}; refused")


def _drop(_: bytes) -> None:
    """Sends nothing: the run has no public bus."""
