"""What a host uses of the process that it runs in, besides sockets and time."""

from collections.abc import Callable
from dataclasses import dataclass

from fwk.engine.runner import Runner
from fwk.host.background_server import Background, no_background


def _never() -> bool:
    return False


def _nothing() -> None:
    pass


@dataclass(frozen=True)
class ProcessHooks:
    """Ties a host to its process; the defaults are those of a host without a process of its own."""

    stopping: Callable[[], bool] = _never
    """Returns whether the process has been asked to stop."""
    make_runner: Callable[..., Runner] = Runner
    """Builds the runner of a component, for example one that is profiled."""
    background: Background = no_background
    """Serves other hosts while a continuous component iterates."""
    initialized: Callable[[], None] = _nothing
    """Called when every `init` has returned."""
