"""For peers with callbacks from their own threads: ticks are queued, of all other data the newest is kept."""

from collections.abc import Sequence
from queue import Empty, SimpleQueue
from typing import Generic, TypeVar

T = TypeVar("T")


class Inbox(Generic[T]):
    """Arrived messages of a component; filled by callbacks, emptied by the component's loop."""

    def __init__(self, sources: Sequence[int]) -> None:
        self._ticks: SimpleQueue[int] = SimpleQueue()
        self._newest: dict[int, T | None] = dict.fromkeys(sources)

    def put_tick(self, tick: int) -> None:
        """Takes a tick."""
        self._ticks.put(tick)

    def put(self, source: int, message: T) -> None:
        """Takes a message of a source."""
        self._newest[source] = message

    def tick(self) -> int:
        """Waits for the next tick."""
        return self._ticks.get()

    def newest(self) -> list[T | None]:
        """Returns the newest message of each source."""
        return list(self._newest.values())


class Answers:
    """Dones that have arrived at the supervisor."""

    def __init__(self) -> None:
        self._answers: SimpleQueue[tuple[int, int]] = SimpleQueue()

    def put(self, component: int, tick: int) -> None:
        """Takes an answer."""
        self._answers.put((component, tick))

    def take(self, timeout_s: float) -> tuple[int, int] | None:
        """Returns the next answer; None if none comes in time."""
        try:
            return self._answers.get(timeout=timeout_s)
        except Empty:
            return None
