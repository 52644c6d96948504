"""What a run is asked for beside its plan, and what came of it."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lcmtypes.core import status_t


@dataclass(frozen=True)
class RunOptions:
    """How long, how fast, recorded where, shown how."""

    run_dir: Path
    """Folder of this run, already there: resolved plan, effective configuration, text log, recording."""
    name: str = ""
    """Name of the run for tools; empty: that of the plan."""
    ticks: int | None = None
    """Stop after so many ticks."""
    time_s: float | None = None
    """Stop after so much logical time."""
    speed: float = 1.0
    """Logical seconds per wall second; 0: as fast as it goes."""
    record: Path | None = None
    """Where the LCM log goes; None: no recording."""
    video: Path | None = None
    """Where a video of the run goes; the launcher draws it from the recording when the run has ended."""
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


class RunBroken(Exception):  # noqa: N818 - what happened to the run
    """A process that no run can do without has ended; says which and how."""


@dataclass(frozen=True)
class Outcome:
    """How a run ended."""

    exit_code: int
    """0: all went well; 1: a component failed or the run broke."""
    ticks: int
    logical_s: float
    wall_s: float
    reason: str
    """Why it ended, for people: `600 ticks done`, `interrupted`, `cyan1/base failed: ...`."""
    status: status_t = field(default_factory=status_t)
    """The supervisor's last view of all components."""
    newest: dict[str, Any] = field(default_factory=dict)
    """Newest message of each mirrored channel, decoded."""
    unrecorded: int = 0
    """Messages that were lost on their way to the recording."""
