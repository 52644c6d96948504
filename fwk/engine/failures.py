"""Failures of components: component, place and reason, in its state and in the log."""

from bdb import BdbQuit
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager

from fwk.component.log import Logger, own_frame
from fwk.engine.metrics import ComponentMetrics, told

_RESERVED = 4000  # small objects, a quarter of a megabyte together


class ComponentFailedError(Exception):
    """A component failed; the text names the component, the place and the reason."""


class DebuggerLeft(BaseException):
    """The user has left the debugger; like Ctrl-C no `Exception`, so that no code on its way takes it for a failure."""


class Failures:
    """Attributes exceptions to the component that raised them.

    Args:
        metrics: states of the components, by name.
        memory_limit_mb: limit of the process; 0: none.
        lift_memory_limit: ends the limit, so that a failure for lack of memory can be reported.
        log: where failures are reported.
    """

    def __init__(
        self,
        metrics: Mapping[str, ComponentMetrics],
        memory_limit_mb: float,
        lift_memory_limit: Callable[[], None],
        log: Logger,
    ) -> None:
        self._metrics = metrics
        self._memory_limit_mb = memory_limit_mb
        self._lift_memory_limit = lift_memory_limit
        self._log = log
        # A component that has used up all memory with small objects leaves none for the report.
        self._reserve: list[list[int]] = [[] for _ in range(_RESERVED if memory_limit_mb else 0)]

    @contextmanager
    def guard(self, name: str, moment: str) -> Iterator[None]:
        """Attributes every exception inside to the component.

        Raises:
            ComponentFailedError: an exception was raised, unless it left the debugger or ends the process.
        """
        try:
            yield
        except BaseException as error:
            self.put(name, moment, error)
            raise

    def make_room(self, error: BaseException) -> None:
        """Frees memory for the report if memory ran out."""
        if isinstance(error, MemoryError):
            self._reserve.clear()
            self._lift_memory_limit()

    def put(self, name: str, moment: str, error: BaseException) -> None:
        """Marks a component as failed and logs the reason with the traceback.

        Raises:
            ComponentFailedError: always, unless the exception left the debugger or ends the process.
        """
        if isinstance(error, DebuggerLeft | BdbQuit | KeyboardInterrupt):
            return
        self.make_room(error)
        frame = own_frame(error)
        place = f"{frame.filename}:{frame.lineno}, " if frame else ""
        reason = f"{self._described(error)} ({place}in {moment})"
        self._metrics[name].state, self._metrics[name].reason = "failed", reason
        self._log.named(name).exception(f"failed in {moment}", error)
        raise ComponentFailedError(f"{name}: {reason}") from error

    def _described(self, error: BaseException) -> str:
        limit = self._memory_limit_mb
        over = f"more memory than its memory_limit_mb of {limit:g}" if limit and isinstance(error, MemoryError) else ""
        return f"{type(error).__name__}: {over}" if over else told(error)
