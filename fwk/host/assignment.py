"""What a host process is told when it starts."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from fwk.component.declaration import Declaration
from fwk.component.images import Ring
from fwk.host.crash_marker import Progress
from fwk.model.plan import Plan


@dataclass(frozen=True)
class Start:
    """What differs from start to start of a host."""

    incarnation: int
    sequences: Mapping[str, int]
    """Sequence numbers that its channels have reached, for one that was restarted."""
    settings: Mapping[str, str]
    """Settings of its components that were changed since the run began, by name, as JSON."""
    blackboard: str = "[]"
    """What was opened at run time, as facts in JSON."""
    newest_change: int = 0
    """Number of the newest change of settings or of the blackboard that is in these: older ones are not told anew."""
    tick: int = 0
    """The newest one when it is started; what it logs before its own first one is of that."""
    time_us: int = 0
    """Logical time of that."""


@dataclass(frozen=True)
class Assignment:
    """What a host process is told when it starts."""

    plan: Plan
    host: int
    run: int
    start: Start
    rings: Mapping[str, Ring]
    fresh_code: bool = False
    """Whether it imports the application's modules anew."""
    progress: Progress | None = None
    """Where it says which of its components works."""
    before: Mapping[str, Declaration] = field(default_factory=dict)
    """With fresh code: what its components' classes said until then, by name."""
