"""What the main loop decides in each tick, on its way to the gateway: kept, and sent again to who lacks it."""

import contextlib
import struct
import sys
from collections import deque
from collections.abc import Callable, Sequence

from fwk.bus import sync
from fwk.bus.network import Steps
from fwk.bus.sender import Sender
from fwk.engine.visibility import Ledger
from fwk.lcm.messages import MessageError
from fwk.model.ports import Ports
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.processes.host_process import Change
from lcmtypes.core import change_t, fetch_t, tick_record_t, void_t

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
        self._events: list[sync.Event] = []
        self._marks: dict[int, int] = {}
        self._changes: list[Change] = []
        events.watch(sender.socket, self._on_asked)

    def event(self, kind: int, index: int, tick: int = 0, stage: int = 0) -> None:
        """Something happened, as in core.tick_event_t."""
        self._events.append((kind, index, tick, stage))

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
        record = tick_record_t()
        record.run, record.changes, record.n_changes = self._run, [change_message(change)], 1
        data = record.encode()
        until_us = self._loop.now_us() + patience_us if patience_us else sys.maxsize
        wait_us, due_us = FIRST_WAIT_US, 0
        while self.heard < change.number and not interrupted() and (now_us := self._loop.now_us()) < until_us:
            if now_us >= due_us:
                self._sender.publish(sync.OPENS, data, self._ports.record)
                due_us = now_us + wait_us
                wait_us = min(2 * wait_us, LONGEST_WAIT_US)
            yield from self._loop.wait(min(due_us, until_us))

    def publish(self, tick: int, time_us: int, voids: Sequence[void_t]) -> None:
        """Sends the record of a tick that has ended, and keeps it for a while."""
        record = tick_record_t()
        record.run, record.tick, record.time_us = self._run, tick, time_us
        record.channel, record.sequence = list(self._marks), list(self._marks.values())
        record.n_marks = len(record.channel)
        record.voids, record.n_voids = list(voids), len(voids)
        record.changes = [change_message(change) for change in self._changes]
        record.n_changes = len(record.changes)
        data = sync.encode_record(record, self._events)
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
        with contextlib.suppress(MessageError, ValueError, struct.error):  # a stranger's; hosts' complaints name it
            message = self._sender.receive(self._ports.members)
            if message and message[0] == b"fwk/fetch":
                fetch = fetch_t.decode(message[1])
                if fetch.run == self._run:
                    self.repeat(fetch.first_sequence, fetch.last_sequence)


def change_message(change: Change) -> change_t:
    """New settings of a component, as they are told and recorded."""
    made = change_t()
    made.component, made.number, made.settings = change.component, change.number, change.settings
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
