"""Tick records of the supervisor, checked and in the order of their ticks; missing records are requested again."""

from collections.abc import Callable

from fwk.bus import sync
from fwk.bus.network import Network
from fwk.bus.receiver import Complaints, Receiver
from fwk.bus.retransmission import Backoff
from fwk.bus.sender import NEVER_US, Sender
from fwk.gateway.dynamic_channels import FollowedChannels
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from lcmtypes.core import announcement_t, fetch_records_t, protocol_t, tick_record_t

SECOND_REQUEST_US = 5_000
LONGEST_REQUEST_US = 20_000


class RecordQueue:
    """Receives the tick records of a run, and the announcements of channels that are about to open.

    Args:
        plan: the plan.
        run: identifier of the run.
        network: sockets and time.
        sender: sends the requests.
        complaints: takes what was refused.
        dynamic: the dynamic channels, which announcements and records change.
        report: tells the supervisor what has arrived here.
    """

    def __init__(
        self,
        plan: Plan,
        run: int,
        network: Network,
        sender: Sender,
        complaints: Complaints,
        dynamic: FollowedChannels,
        report: Callable[[], None],
    ) -> None:
        ports = Ports.of(plan)
        source = network.group_socket(ports.record)
        self.receiver = Receiver(source, (ports.supervisor,), "the supervisor's", "fwk/record", complaints)
        self.next = 1
        """Tick whose record comes next."""
        self._run = run
        self._now_us = network.now_us
        self._sender = sender
        self._supervisor = ports.supervisor
        self._dynamic = dynamic
        self._report = report
        self._channels = len(plan.channels) + plan.spare_channels
        self._waiting: dict[int, tuple[tick_record_t, bytes]] = {}
        self._request: Backoff | None = None  # of the record that is missing

    @property
    def due_us(self) -> int:
        """Wall time at which a missing record is requested again."""
        return self._request.due_us if self._request else NEVER_US

    def receive(self) -> None:
        """Takes everything that has arrived."""
        for channel, data in self.receiver.messages(sync.RECORD, sync.ANNOUNCE):
            try:
                if channel == sync.ANNOUNCE:
                    self._hear_announcement(sync.decode_announcement(data))
                else:
                    self._hear_record(sync.decode_record(data), data)
            except (MessageError, ValueError) as error:
                self.receiver.refuse(str(error))

    def take(self) -> tuple[tick_record_t, bytes] | None:
        """Removes and returns the next tick's record, decoded and as it came; None if it has not arrived."""
        return self._waiting.pop(self.next, None)

    def taken(self) -> None:
        """Notes that the tick of the last record is complete here."""
        self.next += 1
        self._request = None  # each record has waits of its own
        self._report()

    def request_missing(self) -> None:
        """Asks the supervisor for missing records, repeatedly until they come."""
        if self.next in self._waiting or not self._waiting:
            self._request = None
            return
        now_us = self._now_us()
        self._request = self._request or Backoff(now_us, 0, LONGEST_REQUEST_US, SECOND_REQUEST_US)
        if now_us >= self._request.due_us:
            self._request.repeated(now_us)
            fetch = fetch_records_t()
            fetch.run, fetch.first_tick, fetch.last_tick = self._run, self.next, min(self._waiting) - 1
            self._sender.send(sync.FETCH_RECORDS, fetch.encode(), self._supervisor)

    def _hear_announcement(self, announcement: announcement_t) -> None:
        if announcement.run == self._run:
            self._dynamic.announce(announcement.change)
            self._report()

    def _hear_record(self, record: tick_record_t, data: bytes) -> None:
        if record.run != self._run:
            return
        self._check(record)
        if record.tick >= self.next:
            self._waiting[record.tick] = (record, data)
        else:
            self._report()

    def _check(self, record: tick_record_t) -> None:
        """Raises ValueError or MessageError for a record that names what the plan does not have."""
        named = [*record.channel, *(each.channel for each in record.voids)]
        if record.version != protocol_t.VERSION:
            raise MessageError(f"protocol version {record.version}, this gateway has {protocol_t.VERSION}")
        if any(not 0 <= channel < self._channels for channel in named):
            raise MessageError("a tick record with a channel that the plan does not have")
        if record.channels:
            self._dynamic.check(record.channels)
