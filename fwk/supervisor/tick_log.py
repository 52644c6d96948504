"""The supervisor's decisions of each tick, kept and sent again until the gateway has them."""

import json
import sys
from collections import deque
from collections.abc import Callable, Iterable, Sequence

from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.receiver import Receiver
from fwk.bus.retransmission import Backoff
from fwk.engine.visibility import Visibility
from fwk.lcm.messages import MessageError
from fwk.model.channel_table import change_message
from fwk.model.plain_values import value_messages
from fwk.model.tick_events import TickEvent, events_message
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import Change
from lcmtypes.core import announcement_t, protocol_t, recorded_t, settings_change_t, tick_record_t, tick_t, void_t

KEPT = 64
"""Number of ticks that are kept; those that the gateway has not taken yet are kept as well."""
FIRST_WAIT_US = 20_000
LONGEST_WAIT_US = 100_000
STALLED_US = 200_000
"""A wait for the gateway that takes longer is reported."""


class TickLog:
    """The record of the running tick, and those of earlier ticks, which the gateway fetches when it lacks them."""

    def __init__(self, core: Core) -> None:
        self.taken = -1
        """Newest tick that the gateway has; 0: it receives from now on; -1: it does not listen yet."""
        self.stalled = False
        """Whether the loop waits longer than usual for the gateway."""
        self._listens_to = 0  # newest change whose channels the gateway listens to
        self._core = core
        self._kept: deque[tuple[int, bytes]] = deque()
        self._events: list[TickEvent] = []
        self._marks: dict[int, int] = {}
        self._changes: list[Change] = []
        ports = core.ports
        # Hosts also refuse datagrams of other programs and name them, so they are not reported here.
        self._own = Receiver(core.sender.socket, ports.members, "of this run", "fwk/fetch_records", _ignore)
        core.events.watch(self._own, self._answer_fetch)

    def event(self, event: TickEvent) -> None:
        """Adds an event to the record of the running tick."""
        self._events.append(event)

    def mark(self, channel: int, sequence: int) -> None:
        """Moves a mark in the record of the running tick."""
        self._marks[channel] = sequence

    def change(self, change: Change) -> None:
        """Adds a change that the tick begins with."""
        self._changes.append(change)

    def acknowledge(self, recorded: recorded_t) -> None:
        """Takes from the gateway's report which tick it has and which channels it listens to."""
        self.taken = max(self.taken, recorded.tick)
        self._listens_to = max(self._listens_to, recorded.change)

    def announce(self, change: Change, longest_us: int, interrupted: Callable[[], bool]) -> Steps[None]:
        """Waits until the gateway listens to the channels that a change opens, `longest_us` at most; 0: no limit.

        The tick's record names them too, but by then a writer may have sent a message and died.
        """
        core = self._core
        announcement = announcement_t()
        announcement.run, announcement.change = core.run, change_message(change.number, change.facts)
        data = announcement.encode()
        until_us = core.now_us() + longest_us if longest_us else sys.maxsize
        repeats = Backoff(core.now_us(), 0, LONGEST_WAIT_US, FIRST_WAIT_US)
        while self._listens_to < change.number and not interrupted() and (now_us := core.now_us()) < until_us:
            if now_us >= repeats.due_us:
                core.sender.publish(sync.ANNOUNCE, data, core.ports.record)
                repeats.repeated(now_us)
            yield from core.events.wait(min(repeats.due_us, until_us))

    def publish(self, tick: int, time_us: int, voids: Sequence[void_t]) -> None:
        """Sends the record of a tick that has ended, and keeps it for a while."""
        record = tick_record_t()
        record.version, record.run = protocol_t.VERSION, self._core.run
        record.tick, record.time_us = tick, time_us
        record.channel, record.sequence = list(self._marks), list(self._marks.values())
        record.voids = list(voids)
        put_changes(record, self._changes)
        record.events = events_message(self._events)
        data = sync.encode_record(record)
        self._events, self._marks, self._changes = [], {}, []
        self._kept.append((tick, data))
        while len(self._kept) > KEPT and self._kept[0][0] <= self.taken:
            self._kept.popleft()
        self._core.sender.publish(sync.RECORD, data, self._core.ports.record)

    def wait_for(self, tick: int, interrupted: Callable[[], bool]) -> Steps[None]:
        """Waits until the gateway has `tick`; repeats records that it may have lost."""
        now_us = self._core.now_us
        wait_us, began_us = FIRST_WAIT_US, now_us()
        while self.taken < tick and not interrupted():
            self.stalled = now_us() >= began_us + STALLED_US
            before = self.taken
            yield from self._core.events.wait(now_us() + wait_us)
            if self.taken == before:
                wait_us = min(2 * wait_us, LONGEST_WAIT_US)
                self._repeat(self.taken + 1, tick + KEPT)
        self.stalled = False

    def _repeat(self, first: int, last: int) -> None:
        """Repeats the records of these ticks, a limited number at once."""
        for tick, data in self._kept:
            if first <= tick <= min(last, first + KEPT):
                self._core.sender.publish(sync.RECORD, data, self._core.ports.record)

    def _answer_fetch(self) -> None:
        while message := self._own.receive():
            try:
                fetch = sync.decode_fetch_records(message[1]) if message[0] == sync.FETCH_RECORDS else None
            except MessageError as error:
                self._own.refuse(str(error))
                continue
            if fetch and fetch.run == self._core.run:
                self._repeat(fetch.first_tick, fetch.last_tick)


def _ignore(_channel: str, _reason: str) -> None:
    """Ignores a refused datagram."""


def put_changes(message: tick_t | tick_record_t, changes: Iterable[Change]) -> None:
    """Writes changes of settings and of channels into a tick or a tick record."""
    message.settings, message.channels = [], []
    for change in changes:
        if change.facts:
            message.channels.append(change_message(change.number, change.facts))
        else:
            message.settings.append(_settings_message(change))


def _settings_message(change: Change) -> settings_change_t:
    made = settings_change_t()
    made.number, made.component = change.number, change.component
    made.values = value_messages(json.loads(change.settings))
    return made


def void_messages(ledger: Visibility, since: int) -> list[void_t]:
    """Returns the voids for a receiver whose last tick was of step `since` of the ledger."""
    made = []
    for void in ledger.voids_since(since):
        message = void_t()
        message.channel, message.above_sequence = void.channel, void.above_sequence
        message.up_to_tick, message.before_incarnation = void.up_to_tick, void.before_incarnation
        made.append(message)
    return made
