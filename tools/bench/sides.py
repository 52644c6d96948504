"""Interface of a peer: one side for the supervisor, one for each component."""

from collections.abc import Sequence
from importlib import import_module
from typing import Any, Protocol

from tools.bench.sample import Sample
from tools.bench.shape import Shape

STOP = -1
"""The tick that ends a component."""


class SupervisorSide(Protocol):
    """Broadcasts stages and takes answers."""

    def begin(self, stage: int, tick: int) -> None:
        """Tells all components of a stage to run their iteration of `tick`."""

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        """Returns the next answer as (component, tick); None when none came in time."""

    def close(self) -> None:
        """Releases sockets and nodes."""


class ComponentSide(Protocol):
    """One component's connection to the others."""

    def tick(self) -> int:
        """Waits for the component's next tick; `STOP` ends it."""

    def new_sample(self) -> Sample:
        """Returns an empty message of the peer's codec."""

    def inputs(self) -> Sequence[Sample | None]:
        """Returns the newest message of each source, in the order of `Shape.sources`; None before the first."""

    def publish(self, sample: Any) -> None:
        """Sends the component's message to its readers."""

    def done(self, tick: int) -> None:
        """Tells the supervisor that the iteration is over."""

    def close(self) -> None:
        """Releases sockets and nodes."""


class PeerModule(Protocol):
    """A module of `tools.bench.peers`."""

    def supervisor(self, shape: Shape) -> SupervisorSide: ...
    def component(self, shape: Shape, index: int) -> ComponentSide: ...


def load(name: str) -> Any:
    """Returns the peer's module, a `PeerModule`."""
    return import_module(f"tools.bench.peers.{name}")
