"""For peers that call back from threads of their own: ticks queued, of everything else the newest kept."""

from collections.abc import Sequence
from queue import Empty, SimpleQueue
from typing import Generic, TypeVar

T = TypeVar("T")


class Inbox(Generic[T]):
    """What has arrived at a component; filled by callbacks, emptied by the component's loop."""

    def __init__(self, sources: Sequence[int]) -> None:
        self._ticks: SimpleQueue[int] = SimpleQueue()
        self._newest: dict[int, T | None] = dict.fromkeys(sources)

    def put_tick(self, tick: int) -> None:
        """A tick came."""
        self._ticks.put(tick)

    def put(self, source: int, message: T) -> None:
        """A message of a source came."""
        self._newest[source] = message

    def tick(self) -> int:
        """Waits for the next tick."""
        return self._ticks.get()

    def newest(self) -> list[T | None]:
        """The newest message of each source."""
        return list(self._newest.values())


class Answers:
    """Dones that have arrived at the supervisor."""

    def __init__(self) -> None:
        self._answers: SimpleQueue[tuple[int, int]] = SimpleQueue()

    def put(self, component: int, tick: int) -> None:
        """An answer came."""
        self._answers.put((component, tick))

    def take(self, timeout_s: float) -> tuple[int, int] | None:
        """The next answer; None when none comes in time."""
        try:
            return self._answers.get(timeout=timeout_s)
        except Empty:
            return None
