"""The assignment of a host: plan, its host in it, and the state of the run when the host starts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Protocol

from fwk.component.declaration import Declaration
from fwk.component.images import Frames, Ring
from fwk.model.plan import Plan


class WorkMarker(Protocol):
    """Remembers which component of each host is being executed."""

    def works(self, host: int, component: int) -> None:
        """Notes that a component of the host is being executed; `NOBODY`: none is."""

    def at(self, host: int) -> int:
        """Returns the index of the component of the host that is being executed."""


@dataclass(frozen=True)
class Start:
    """State of the run when an incarnation of a host starts."""

    incarnation: int
    sequences: Mapping[str, int]
    """Sequence numbers that its channels have reached, by name; of a first incarnation none."""
    settings: Mapping[str, str]
    """Settings of its components that were changed since the run began, by name, as JSON."""
    blackboard: str = "[]"
    """The dynamic channels that are open, as facts in JSON."""
    newest_change: int = 0
    """Number of the newest change of settings or of the blackboard that is included; older ones are not sent again."""
    tick: int = 0
    """The newest tick when the host is started; lines that it logs before its own first tick carry it."""
    time_us: int = 0
    """Logical time of that tick."""


@dataclass(frozen=True)
class Assignment:
    """Data that a host is given when it starts."""

    plan: Plan
    host: int
    run: int
    start: Start
    rings: Mapping[str, Ring]
    """Shared-memory rings of the cameras, by channel."""
    fresh_code: bool = False
    """Whether the process imports the application's modules anew."""
    marker: WorkMarker | None = None
    """Marker in which the host notes the component that it executes."""
    before: Mapping[str, Declaration] = field(default_factory=dict)
    """With fresh code: what the components' classes declared until then, by component."""
    further_stages: Sequence[int] = ()
    """Stages whose ticks the host answers besides those of its components."""
    frames: Mapping[str, Frames] = field(default_factory=dict)
    """Sources of frames that replace the rings, by channel."""
