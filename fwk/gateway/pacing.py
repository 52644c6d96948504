"""Paces what the gateway publishes: the messages of a tick are spread over the time until the next tick.

A tick's messages become visible at once, several hundred in a large system. A receiver with default settings (30
messages in the queue of a subscription, 208 KiB in the socket) loses most of such a burst. So the datagrams wait and
leave a few at a time, and only when the listeners of this machine have handled those before. The run does not wait for
any of this: the queue empties within a tick if it can, else over several. While no program can listen, the datagrams
are dropped.
"""

from collections import deque
from collections.abc import Callable, Iterable

SLOT_US = 1_000
"""Wall time from one group of datagrams to the next."""
SLOT_BYTES = 2_048
"""A datagram counts as one for each begun piece of this size."""
LEAST = 4
"""Smallest number of datagrams in a group."""
LARGEST = 14
"""Largest number of datagrams in a group: two groups fit into the queue of a subscription.

A Java program pauses for some milliseconds to collect garbage, which its other threads do not show. Its socket holds
the groups of that time, not more.
"""
QUEUE_MAX = 65_536
"""Largest number of waiting datagrams, some 30 MB of small messages; the excess leaves at once.

Room for what a run at full speed writes in half a minute: three listeners beside 104 hosts on two cores take that
long to catch up.
"""
LONGEST_US = 250_000
"""Longest wall time over which the messages of a tick are spread."""
_NEVER = 1 << 62
_WEIGHT = 0.2  # share of the mean time between ticks


class PacedPublisher:
    """Queue of datagrams that leave in groups, one group a slot.

    Args:
        now_us: returns the wall time in microseconds.
        send: sends one datagram.
        busy_listeners: returns the names of the programs that have not handled earlier datagrams; None if no program
        can listen.
        patience_us: longest wall time that the queue waits for a busy listener. One that stays busy for longer is not
        waited for until it has been idle again, so that only that listener lacks datagrams.
    """

    def __init__(
        self,
        now_us: Callable[[], int],
        send: Callable[[bytes], None],
        busy_listeners: Callable[[], list[str] | None],
        patience_us: int,
    ) -> None:
        self.unheard = False
        """Whether no program can listen: what is put now would be dropped."""
        self.overrun = ""
        """Listener that was busy for so long that it may lack datagrams, the newest one; empty: none."""
        self._now_us = now_us
        self._send = send
        self._busy_listeners = busy_listeners
        self._patience_us = patience_us
        self._queue: deque[bytes] = deque()
        self._size = 0  # datagrams in the queue that count
        self._group = LEAST
        self._due_us = 0
        self._busy_us: dict[str, int] = {}  # by busy listener: wall time since which it is
        self._tick_us = now_us()  # wall time of the newest tick
        self._interval_us = float(LONGEST_US)  # mean wall time between ticks

    @property
    def due_us(self) -> int:
        """Wall time at which the next group may leave; far in the future while the queue is empty."""
        return self._due_us if self._queue else _NEVER

    @property
    def waiting(self) -> int:
        """Number of datagrams in the queue."""
        return len(self._queue)

    def put(self, datagrams: Iterable[bytes]) -> None:
        """Adds the datagrams of a message."""
        for datagram in datagrams:
            self._queue.append(datagram)
            self._size += _size_of(datagram)

    def tick(self) -> None:
        """Spreads the waiting datagrams over the time until the next expected tick."""
        now_us = self._now_us()
        elapsed_us, self._tick_us = min(now_us - self._tick_us, LONGEST_US), now_us
        self._interval_us += _WEIGHT * (elapsed_us - self._interval_us)
        slots = max(1, int(self._interval_us / SLOT_US) - 1)
        self._group = min(max(LEAST, -(-self._size // slots)), LARGEST)

    def send_due(self) -> None:
        """Sends the next group if its time has come; drops all datagrams if no program can listen."""
        now_us = self._now_us()
        is_due = bool(self._queue) and now_us >= self._due_us
        if not (is_due or self.unheard):
            return
        busy = self._busy_listeners()
        self.unheard = busy is None
        if busy is None:
            self._queue.clear()
            self._size = 0
        if busy is None or not is_due:
            return
        excess = self._size - QUEUE_MAX
        self._busy_us = {name: self._busy_us.get(name, now_us) for name in busy}
        self._due_us = now_us + SLOT_US
        overdue = [name for name, since_us in self._busy_us.items() if now_us >= since_us + self._patience_us]
        if len(overdue) < len(busy) and excess <= 0:
            return
        lacking = overdue if excess <= 0 else busy
        self.overrun = lacking[0] if lacking and self.overrun not in lacking else self.overrun
        self._send_group(max(self._group, excess))

    def send_all(self) -> None:
        """Sends whatever waits; listeners may lack some of it."""
        self.overrun = next(iter(self._busy_listeners() or ()), self.overrun or "a listener")
        self._send_group(self._size)

    def _send_group(self, left: int) -> None:
        while self._queue and left > 0:
            datagram = self._queue.popleft()
            left -= _size_of(datagram)
            self._size -= _size_of(datagram)
            self._send(datagram)


def _size_of(datagram: bytes) -> int:
    return 1 + len(datagram) // SLOT_BYTES
