"""Paces what the gateway publishes: the messages of a tick are spread over the time until the next tick.

A tick's messages become visible at once, several hundred in a large system. A receiver with default settings (30
messages in the queue of a subscription, 208 KiB in the socket) loses most of such a burst, so the datagrams wait and
leave a few at a time. The run does not wait for them: the queue empties within a tick if it can, else over several.
"""

from collections import deque
from collections.abc import Callable, Iterable

SLOT_US = 1_000
"""Wall time from one group of datagrams to the next."""
SLOT_BYTES = 2_048
"""A datagram counts as one for each begun piece of this size."""
LEAST = 4
"""Datagrams of a group, at the least."""
LARGEST = 12
"""Datagrams of a group, at the most: two groups fit into the queue of a subscription."""
QUEUE_MAX = 16_384
"""Datagrams that wait, at the most; of a system that writes more, what is beyond leaves at once."""
LONGEST_US = 50_000
"""Wall time over which the messages of a tick are spread, at the most."""
_NEVER = 1 << 62
_WEIGHT = 0.2  # of the newest tick in the mean time between ticks


class PacedPublisher:
    """Queue of datagrams that leave in groups, one group a slot.

    Args:
        now_us: returns the wall time in microseconds.
        send: sends one datagram.
    """

    def __init__(self, now_us: Callable[[], int], send: Callable[[bytes], None]) -> None:
        self._now_us = now_us
        self._send = send
        self._queue: deque[bytes] = deque()
        self._size = 0  # of the queue, in datagrams that count
        self._group = LEAST
        self._due_us = 0
        self._tick_us = now_us()  # wall time of the newest tick
        self._interval_us = float(LONGEST_US)  # mean wall time between ticks

    @property
    def due_us(self) -> int:
        """Wall time at which the next group may leave; far away while nothing waits."""
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
        """Spreads what waits over the time until the next tick is expected."""
        now_us = self._now_us()
        elapsed_us, self._tick_us = min(now_us - self._tick_us, LONGEST_US), now_us
        self._interval_us += _WEIGHT * (elapsed_us - self._interval_us)
        slots = max(1, int(self._interval_us / SLOT_US) - 1)
        self._group = min(max(LEAST, -(-self._size // slots)), LARGEST)

    def send_due(self) -> None:
        """Sends the next group if its time has come, two of them if the process was late."""
        now_us = self._now_us()
        if not self._queue or now_us < self._due_us:
            return
        late = now_us >= self._due_us + SLOT_US > SLOT_US
        self._send_group(max(self._group * (1 + late), self._size - QUEUE_MAX))
        self._due_us = now_us + SLOT_US

    def _send_group(self, left: int) -> None:
        while self._queue and left > 0:
            datagram = self._queue.popleft()
            size = _size_of(datagram)
            self._size -= size
            left -= size
            self._send(datagram)


def _size_of(datagram: bytes) -> int:
    return 1 + len(datagram) // SLOT_BYTES
