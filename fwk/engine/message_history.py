"""The newest messages that a writer has sent, kept for readers that lose some of them."""

from collections import deque
from collections.abc import Iterable, Iterator

MESSAGES_MAX = 256
BYTES_MAX = 64 << 20
TICKS = 17
"""Ticks for which messages are kept: the recorder may be 16 ticks behind."""


def gaps(there: Iterable[int], first: int, last: int) -> Iterator[tuple[int, int]]:
    """Yields the ranges from `first` to `last` that are not in `there`, each with its first and last number.

    Args:
        there: numbers in ascending order.
        first: the first number that counts.
        last: the last number that counts.
    """
    expected = first
    for number in (*there, last + 1):
        if number > expected:
            yield expected, number - 1
        expected = number + 1


class MessageHistory:
    """The newest messages of one channel by sequence number.

    It always keeps the messages of the running and the previous tick: in lockstep no reader but the recorder is further
    behind. For the recorder it keeps those of 17 ticks as long as they take at most 64 MiB, and always 256 messages.
    """

    def __init__(self) -> None:
        self._kept: deque[tuple[int, int, bytes]] = deque()
        self._bytes = 0

    def add(self, tick: int, sequence: int, data: bytes) -> None:
        """Keeps a message that was written in this tick, and drops messages that are too old."""
        kept = self._kept
        kept.append((tick, sequence, data))
        self._bytes += len(data)
        while (len(kept) > MESSAGES_MAX and tick - kept[0][0] > TICKS) or (
            self._bytes > BYTES_MAX and tick - kept[0][0] > 1
        ):
            self._bytes -= len(kept.popleft()[2])

    @property
    def newest(self) -> int:
        """Returns the newest sequence number; 0: none."""
        return self._kept[-1][1] if self._kept else 0

    def between(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """Returns the kept messages `first` to `last`, oldest first."""
        return [(sequence, data) for _, sequence, data in self._kept if first <= sequence <= last]
