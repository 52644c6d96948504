"""Sections that a launch file and the plan have in common; limits of values are checked when a file is read."""

from dataclasses import dataclass
from typing import Annotated, Any, Literal

from annotated_types import Ge, Gt, Le

from fwk.clock import SECONDS_MAX

RestartWhen = Literal["never", "on-failure", "always"]
TargetLevel = Literal["debug", "info", "warning", "error", "off"]
"""Lowest level of the lines that a target takes; `off`: none."""

_CONFIG: Any = {"extra": "forbid", "allow_inf_nan": False}


@dataclass(frozen=True)
class RestartPolicy:
    """Condition for starting a component again that ended."""

    __pydantic_config__ = _CONFIG
    when: RestartWhen = "on-failure"
    """Ends after which it is started again."""
    backoff_s: Annotated[float, Ge(0.0), Le(SECONDS_MAX)] = 0.1
    """Wait before the first restart; it doubles with each further one."""
    limit: Annotated[int, Ge(0)] = 5
    """Largest number of restarts within the window."""
    window_s: Annotated[float, Gt(0.0), Le(SECONDS_MAX)] = 60.0
    """Length of the window."""


@dataclass(frozen=True)
class LogPlan:
    """Targets of the log with their lowest levels, and limits on the number of lines."""

    __pydantic_config__ = _CONFIG
    console: TargetLevel = "info"
    """Lines on the terminal."""
    file: TargetLevel = "debug"
    """Lines in `fwk.log`, for people."""
    json_lines: TargetLevel = "debug"
    """Lines in `fwk.log.jsonl`, for programs."""
    bus: TargetLevel = "debug"
    """Lines on the public bus."""
    recording: TargetLevel = "debug"
    """Lines in the recording."""
    syslog: TargetLevel = "off"
    """Lines in the system's log."""
    syslog_to: str = "/dev/log"
    """Path of the syslog daemon's socket, or its `ADDRESS:PORT`."""
    file_mb: Annotated[float, Ge(0.01), Le(1e6)] = 16.0
    """Size at which a file is renamed and a new file begun."""
    files: Annotated[int, Ge(1), Le(1000)] = 4
    """Number of files that are kept, with the one being written."""
    lines_per_s: Annotated[int, Ge(0)] = 200
    """Largest number of lines per second of one component, and of the output of one process; 0: no limit."""


@dataclass(frozen=True)
class RunsPlan:
    """Run directories that are kept when a run begins."""

    __pydantic_config__ = _CONFIG
    keep: Annotated[int, Ge(0)] = 100
    """Number of the newest run directories that are kept; 0: all."""
    size_gb: Annotated[float, Ge(0.0), Le(1e6)] = 20.0
    """Largest size of all run directories together; 0: no limit."""


@dataclass(frozen=True)
class RecordPlan:
    """Contents of a recording."""

    frames: tuple[str, ...] = ()
    """Channels of cameras whose frames are recorded."""
    channels: tuple[str, ...] = ()
    """Channels that are recorded: names, patterns or namespaces; none means all."""
    exclude: tuple[str, ...] = ()
    """Channels of these that are not recorded."""
    size_gb: float = 0.0
    """Size at which the recording ends, after a whole tick, while the run goes on; 0: no limit."""
    split_mb: float = 0.0
    """Size at which a part of the recording ends and the next one begins, after a whole tick; 0: no limit."""
    split_s: float = 0.0
    """Logical time after which the same happens; 0: no limit."""
    compress: bool = False
    """Whether finished parts are compressed."""

    @property
    def has_all_channels(self) -> bool:
        """Whether every message is recorded, as a replay needs it."""
        return not (self.channels or self.exclude)


def choice_in_words(record: RecordPlan) -> str:
    """Returns which channels are recorded, such as `channels cyan1, without cyan1/image`."""
    parts = {"channels": record.channels, "without": record.exclude}
    return ", ".join(f"{word} {' '.join(patterns)}" for word, patterns in parts.items() if patterns)
