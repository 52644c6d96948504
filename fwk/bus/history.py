"""What a writer has sent lately, kept for readers that lost it."""

from collections import deque

MESSAGES_MAX = 256
BYTES_MAX = 8 << 20


class History:
    """The last messages of one channel by sequence number; always the newest, older ones as memory allows."""

    def __init__(self) -> None:
        self._kept: deque[tuple[int, bytes]] = deque()
        self._bytes = 0

    def add(self, sequence: int, data: bytes) -> None:
        """Keeps a message."""
        kept = self._kept
        kept.append((sequence, data))
        self._bytes += len(data)
        while len(kept) > MESSAGES_MAX or (self._bytes > BYTES_MAX and len(kept) > 1):
            self._bytes -= len(kept.popleft()[1])

    def between(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """The kept messages with these numbers, oldest first."""
        return [(sequence, data) for sequence, data in self._kept if first <= sequence <= last]
