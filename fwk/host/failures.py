"""When a component raises: which one, where and why, in its state and in the log."""

import traceback
from bdb import BdbQuit
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

from fwk.component.log import Logger
from fwk.host.memory import lift_limit
from fwk.host.metrics import Figures, told

_RESERVED = 4000  # small objects, a quarter of a megabyte together


class Failure(Exception):  # noqa: N818 - a failure of a component, not an error of the framework
    """A component failed; the text says which, where and why."""


class Blame:
    """Turns what components of a process raise into a `Failure` of the one that raised it."""

    def __init__(self, figures: Mapping[str, Figures], memory_limit_mb: float, log: Logger) -> None:
        self._figures = figures
        self._memory_limit_mb = memory_limit_mb
        self._log = log
        # Who has used up all memory with small objects leaves none for saying so.
        self._reserve: list[list[int]] = [[] for _ in range(_RESERVED if memory_limit_mb else 0)]

    @contextmanager
    def guard(self, name: str, moment: str) -> Iterator[None]:
        """Whatever is raised inside is the failure of that component.

        Raises:
            Failure: it raised; unless somebody left the debugger, or ends the process.
        """
        try:
            yield
        except BaseException as error:
            self.put(name, moment, error)
            raise

    def make_room(self, error: BaseException) -> None:
        """If it is memory that ran out, there is some from now on: even the words for it take some."""
        if isinstance(error, MemoryError):
            self._reserve.clear()
            lift_limit()

    def put(self, name: str, moment: str, error: BaseException) -> None:
        """Marks a component as failed and logs why, with the traceback.

        Raises:
            Failure: always, unless it is no failure of the component: somebody left the debugger, or ends the process.
        """
        if isinstance(error, BdbQuit | KeyboardInterrupt):
            return
        self.make_room(error)
        trace = traceback.extract_tb(error.__traceback__)  # without memory it was not written down
        place = f"{trace[-1].filename}:{trace[-1].lineno}, " if trace else ""
        reason = f"{self._what(error)} ({place}in {moment})"
        self._figures[name].state, self._figures[name].reason = "failed", reason
        self._log.named(name).exception(f"failed in {moment}", error)
        raise Failure(f"{name}: {reason}") from error

    def _what(self, error: BaseException) -> str:
        limit = self._memory_limit_mb
        over = f"more memory than its memory_limit_mb of {limit:g}" if limit and isinstance(error, MemoryError) else ""
        return f"{type(error).__name__}: {over}" if over else told(error)
