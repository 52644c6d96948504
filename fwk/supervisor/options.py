"""The options of a run beside its plan, and its outcome."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lcmtypes.core import status_t


@dataclass(frozen=True)
class RunOptions:
    """Length, speed, recording and display of a run."""

    run_dir: Path
    """Existing folder of this run: resolved plan, effective configuration, text log, recording."""
    name: str = ""
    """Name of the run for tools; empty: that of the plan."""
    ticks: int | None = None
    """Number of ticks after which the run stops."""
    time_s: float | None = None
    """Logical time in seconds after which the run stops."""
    speed: float = 1.0
    """Logical seconds per wall second; 0: as fast as possible."""
    record: Path | None = None
    """File of the recording; None: no recording."""
    video: Path | None = None
    """File of a video of the run, drawn from the recording after the run."""
    debug: str | None = None
    """Component that runs under pdb in this terminal."""
    debugpy_port: int = 0
    """Instead of pdb, the component waits for an editor's debugger at this port of 127.0.0.1."""
    profile: str | None = None
    """Component whose iterations are profiled."""
    watch: bool = False
    """Components whose source files change are reloaded."""
    plain: bool = False
    """Lines of text instead of the live display, on a terminal too."""


class RunBrokenError(Exception):
    """A process that every run needs has ended; the text names it with its end."""


@dataclass(frozen=True)
class Outcome:
    """End of a run."""

    exit_code: int
    """0: success; 1: a component failed or the run broke."""
    ticks: int
    logical_s: float
    wall_s: float
    reason: str
    """Reason for the end, as text: `600 ticks done`, `interrupted`, `cyan1/base failed: ...`."""
    status: status_t = field(default_factory=status_t)
    """The supervisor's last status."""
    newest: dict[str, Any] = field(default_factory=dict)
    """Newest message of each mirrored channel, decoded."""
    unrecorded: int = 0
    """Messages that the recording lacks: lost on their way to it, or not written."""
    deleted: str = ""
    """File of the run that was deleted during the run, as text; empty: none."""
