"""What a writer has sent lately, kept for readers that lost it."""

from collections import deque
from collections.abc import Iterable, Iterator

MESSAGES_MAX = 256
BYTES_MAX = 64 << 20
TICKS = 17  # the recorder may be 16 ticks behind


def gaps(there: Iterable[int], first: int, last: int) -> Iterator[tuple[int, int]]:
    """The ranges between two numbers that are not there, each with its first and last; `there` is in order."""
    expected = first
    for number in (*there, last + 1):
        if number > expected:
            yield expected, number - 1
        expected = number + 1


class History:
    """The last messages of one channel by sequence number.

    Those of the running and the last tick are always kept: in lockstep nobody is further behind, except the recorder.
    For it those of the last 17 ticks are kept, as long as they take no more than 64 MiB; always up to 256 messages.
    """

    def __init__(self) -> None:
        self._kept: deque[tuple[int, int, bytes]] = deque()
        self._bytes = 0

    def add(self, tick: int, sequence: int, data: bytes) -> None:
        """Keeps a message that was written in this tick, and drops what is too old."""
        kept = self._kept
        kept.append((tick, sequence, data))
        self._bytes += len(data)
        while (len(kept) > MESSAGES_MAX and tick - kept[0][0] > TICKS) or (
            self._bytes > BYTES_MAX and tick - kept[0][0] > 1
        ):
            self._bytes -= len(kept.popleft()[2])

    @property
    def newest(self) -> int:
        """The newest number; 0: none."""
        return self._kept[-1][1] if self._kept else 0

    def between(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """The kept messages with these numbers, oldest first."""
        return [(sequence, data) for _, sequence, data in self._kept if first <= sequence <= last]
