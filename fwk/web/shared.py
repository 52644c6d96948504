"""Answers that all browsers share: the same question is asked at most once in a given time."""

import asyncio
from collections.abc import Awaitable, Callable, Hashable
from typing import Any

from fwk.clock import US_PER_S, monotonic_us

_KEPT_MAX = 500


class Shared:
    """Keeps answers for a short time, so that the load on a run does not depend on the number of open pages."""

    def __init__(self, now_us: Callable[[], int] = monotonic_us) -> None:
        self._now_us = now_us
        self._kept: dict[Hashable, tuple[int, asyncio.Future[Any]]] = {}

    async def get(self, key: Hashable, age_s: float, make: Callable[[], Awaitable[Any]]) -> Any:
        """Returns the answer to a question: one that is at most `age_s` old or under way, else a new one.

        An exception is an answer, too.
        """
        asked_us, kept = self._kept.get(key, (0, None))
        if kept is None or (kept.done() and self._now_us() - asked_us >= age_s * US_PER_S):
            if len(self._kept) >= _KEPT_MAX:
                self._kept = {each: entry for each, entry in self._kept.items() if not entry[1].done()}
            kept = asyncio.ensure_future(make())
            kept.add_done_callback(_noticed)
            self._kept[key] = self._now_us(), kept
        return await asyncio.shield(kept)


def _noticed(answer: asyncio.Future[Any]) -> None:
    """Marks an exception as seen: the browser that asked may have left."""
    if not answer.cancelled():
        answer.exception()
