"""Services of the process that a host runs in, besides sockets and time."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module

from fwk.component.component import Component
from fwk.engine.runner import Runner
from fwk.host.background_server import Background, no_background
from fwk.model.plan import ComponentPlan


def imported_class(component: ComponentPlan) -> type[Component]:
    """Imports the class of a component."""
    found: type[Component] = getattr(import_module(component.module), component.class_name)
    return found


def _never() -> bool:
    return False


def _nothing() -> None:
    pass


@dataclass(frozen=True)
class ProcessHooks:
    """Ties a host to its process; the defaults suit a host without a process of its own."""

    stopping: Callable[[], bool] = _never
    """Returns whether the process has been asked to stop."""
    find_class: Callable[[ComponentPlan], type[Component]] = imported_class
    """Returns the class of a component."""
    make_runner: Callable[..., Runner] = Runner
    """Builds the runner of a component, for example one that is profiled."""
    background: Background = no_background
    """Serves other hosts while a continuous component iterates."""
    initialized: Callable[[], None] = _nothing
    """Called when every `init` has returned."""
    runs_ahead: bool = False
    """Whether the host runs stages within its lookahead without waiting for their ticks; the same either way."""
    reports: bool = True
    """Whether a supervisor listens to the states and figures of the components."""
    lift_memory_limit: Callable[[], None] = _nothing
    """Ends the process's memory limit."""
