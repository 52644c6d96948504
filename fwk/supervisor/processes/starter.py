"""The seam between the supervisor and the part of a run that starts processes."""

from dataclasses import dataclass
from typing import Protocol

from fwk.engine.assignment import Start


@dataclass(frozen=True)
class Started:
    """A host process was started."""

    host: int
    incarnation: int
    pid: int
    streams: tuple[int, int] | None = None
    """Descriptors from which its standard output and error can be read; None: they go elsewhere."""


@dataclass(frozen=True)
class Ended:
    """A host process ended: exit code, or minus the signal that killed it."""

    host: int
    incarnation: int
    pid: int
    code: int
    core: bool = False
    """Whether it left a core dump."""


class ProcessStarter(Protocol):
    """Starts and signals host processes and reports their ends: the zygote, or a simulated world."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there are events."""
        ...

    def start(self, host: int, start: Start, fresh_code: bool) -> None:
        """Asks for a host process; `Started` comes with the events.

        With `fresh_code` the application's modules are imported anew.
        """
        ...

    def signal(self, pid: int, number: int) -> None:
        """Signals a host process; does nothing if the process has ended."""
        ...

    def wake(self) -> None:
        """Lets the starter itself continue if it was stopped."""
        ...

    def events(self) -> list[Started | Ended]:
        """Returns what happened since the last call.

        Raises:
            RunBrokenError: the starter itself ended, and all hosts with it.
        """
        ...

    def debugs(self, host: int) -> bool:
        """Returns whether the first process of a host runs under a debugger."""
        ...

    def component_at(self, host: int) -> int:
        """Returns the index of the component that a host executes, or executed when it ended; -1: no component."""
        ...
