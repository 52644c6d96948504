"""Boundary requests of components and tools, collected during a tick and taken in one order."""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any

TOOLS = ""
"""As the sender of a request: a tool, through the control socket."""
AFTER_ALL_STEPS = 1 << 16
"""As the step of a request of a tool: after all components' requests of the tick."""


@dataclass(frozen=True)
class BoundaryRequest:
    """One request, to be decided at the next boundary."""

    tick: int
    step: int
    sender: str
    """Full name of the component; `TOOLS`: none."""
    order: int
    """Number of the request among those that arrived since the last boundary."""
    kind: str
    """Part of the run that decides it: `main_loop`, `plugins`, `channels`, `settings`."""
    content: Any

    @property
    def key(self) -> tuple[int, int, str, int]:
        """Position in the order of all requests, which does not depend on the order in which dones arrive."""
        return (self.tick, self.step, self.sender, self.order)


class BoundaryRequests:
    """The requests since the last boundary."""

    def __init__(self) -> None:
        self._requests: list[BoundaryRequest] = []

    def __bool__(self) -> bool:
        return bool(self._requests)

    def ask(self, tick: int, step: int, sender: str, kind: str, content: Any) -> None:
        """Adds a request that a component made in its iteration at a step of a tick."""
        self._requests.append(BoundaryRequest(tick, step, sender, len(self._requests), kind, content))

    def drop(self, senders: Collection[str], kinds: Collection[str]) -> None:
        """Drops requests of these kinds: their senders have left the run."""
        self._requests = [each for each in self._requests if each.sender not in senders or each.kind not in kinds]

    def take(self) -> list[BoundaryRequest]:
        """Returns all requests, in the order of tick, step, sender and number; none is left."""
        taken, self._requests = self._requests, []
        return sorted(taken, key=lambda request: request.key)
