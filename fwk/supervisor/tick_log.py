"""What the main loop decides in each tick, on its way to the gateway: kept, and sent again to who lacks it."""

import contextlib
import json
import sys
from collections import deque
from collections.abc import Callable, Iterable, Sequence

from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.sender import Sender
from fwk.engine.visibility import Ledger
from fwk.lcm.messages import MessageError
from fwk.model.channel_table import change_message
from fwk.model.plain_values import value_messages
from fwk.model.ports import Ports
from fwk.model.tick_events import TickEvent, events_message
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.processes.host_process import Change
from lcmtypes.core import announcement_t, protocol_t, settings_change_t, tick_record_t, tick_t, void_t

KEPT = 64  # ticks at the least: all that the gateway has not taken yet
FIRST_WAIT_US = 20_000
LONGEST_WAIT_US = 100_000
STALLED_US = 200_000


class Records:
    """The record of the running tick, and the newest ones before it, for which the gateway asks if it lacks them."""

    def __init__(self, ports: Ports, run: int, sender: Sender, events: EventLoop) -> None:
        self.taken = -1  # newest tick that the gateway has; 0: it hears whatever is sent from now on
        self.heard = 0  # newest change of the blackboard that the gateway was told of beforehand
        self.stalled = False
        """Whether the gateway is waited for longer than usual."""
        self._ports = ports
        self._run = run
        self._sender = sender
        self._loop = events
        self._kept: deque[tuple[int, bytes]] = deque()
        self._events: list[TickEvent] = []
        self._marks: dict[int, int] = {}
        self._changes: list[Change] = []
        events.watch(sender.socket, self._on_asked)

    def event(self, event: TickEvent) -> None:
        """Adds an event to the record of the running tick."""
        self._events.append(event)

    def mark(self, channel: int, sequence: int) -> None:
        """A mark moves."""
        self._marks[channel] = sequence

    def change(self, change: Change) -> None:
        """The tick begins with new settings of a component."""
        self._changes.append(change)

    def announce(self, change: Change, patience_us: int, interrupted: Callable[[], bool]) -> Steps[None]:
        """Waits until the gateway listens to the channels that a change opens, for so long at most; 0: for ever.

        It learns of them from the tick's record, too, but by then a writer may have sent something and died.
        """
        announcement = announcement_t()
        announcement.run, announcement.change = self._run, change_message(change.number, change.facts)
        data = announcement.encode()
        until_us = self._loop.now_us() + patience_us if patience_us else sys.maxsize
        wait_us, due_us = FIRST_WAIT_US, 0
        while self.heard < change.number and not interrupted() and (now_us := self._loop.now_us()) < until_us:
            if now_us >= due_us:
                self._sender.publish(sync.ANNOUNCE, data, self._ports.record)
                due_us = now_us + wait_us
                wait_us = min(2 * wait_us, LONGEST_WAIT_US)
            yield from self._loop.wait(min(due_us, until_us))

    def publish(self, tick: int, time_us: int, voids: Sequence[void_t]) -> None:
        """Sends the record of a tick that has ended, and keeps it for a while."""
        record = tick_record_t()
        record.version, record.run, record.tick, record.time_us = protocol_t.VERSION, self._run, tick, time_us
        record.channel, record.sequence = list(self._marks), list(self._marks.values())
        record.voids = list(voids)
        put_changes(record, self._changes)
        record.events = events_message(self._events)
        data = sync.encode_record(record)
        self._events, self._marks, self._changes = [], {}, []
        self._kept.append((tick, data))
        while len(self._kept) > KEPT and self._kept[0][0] <= self.taken:
            self._kept.popleft()
        self._sender.publish(sync.RECORD, data, self._ports.record)

    def wait_for(self, tick: int, interrupted: Callable[[], bool]) -> Steps[None]:
        """Waits until the gateway has `tick`; what it may have lost is sent again."""
        wait_us, began_us = FIRST_WAIT_US, self._loop.now_us()
        while self.taken < tick and not interrupted():
            now_us = self._loop.now_us()
            self.stalled = now_us >= began_us + STALLED_US
            before = self.taken
            yield from self._loop.wait(now_us + wait_us)
            if self.taken == before:
                wait_us = min(2 * wait_us, LONGEST_WAIT_US)
                self.repeat(self.taken + 1, tick + KEPT)
        self.stalled = False

    def repeat(self, first: int, last: int) -> None:
        """Sends the records of these ticks again, but not too many at once."""
        for tick, data in self._kept:
            if first <= tick <= min(last, first + KEPT):
                self._sender.publish(sync.RECORD, data, self._ports.record)

    def _on_asked(self) -> None:
        with contextlib.suppress(MessageError):  # a stranger's; hosts' complaints name it
            message = self._sender.receive(self._ports.members)
            if message and message[0] == sync.FETCH_RECORDS:
                fetch = sync.decode_fetch_records(message[1])
                if fetch.run == self._run:
                    self.repeat(fetch.first_tick, fetch.last_tick)


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


def void_messages(ledger: Ledger, since: int) -> list[void_t]:
    """What is void, for somebody who was told at step `since` last."""
    made = []
    for void in ledger.voids_since(since):
        message = void_t()
        message.channel, message.above_sequence = void.channel, void.above_sequence
        message.up_to_tick, message.before_incarnation = void.up_to_tick, void.before_incarnation
        made.append(message)
    return made
