"""The shape of a launch file: which keys there are, and what may stand behind them."""

import ipaddress
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN
from fwk.component.declaration import RATE_MAX_HZ

PACE_MAX = "max"


def _as_list(value: Any) -> Any:
    return [value] if isinstance(value, str) else value


def _as_pace(value: Any) -> Any:
    if value == PACE_MAX:
        return 0.0
    if isinstance(value, bool) or not isinstance(value, int | float) or not SPEED_MIN <= value <= SPEED_MAX:
        raise ValueError(f"Input should be a number from {SPEED_MIN:g} to {SPEED_MAX:g}, or {PACE_MAX}")
    return value


def _as_scalar(value: Any) -> Any:
    if value is None or isinstance(value, dict | list):
        raise ValueError("Input should be a word or a number")
    return value


def _as_syslog(to: str) -> str:
    address, _, port = to.rpartition(":")
    try:
        if not to.startswith("/"):
            ipaddress.IPv4Address(address)
            if not (port.isdecimal() and 0 < int(port) < 1 << 16):
                raise ValueError
    except ValueError as error:
        raise ValueError("Input should be a socket's path, or an address and port such as 10.0.0.7:514") from error
    return to


_WORDS = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]}
_PACE = {"anyOf": [{"type": "number", "minimum": SPEED_MIN, "maximum": SPEED_MAX}, {"const": PACE_MAX}]}
_SCALAR = {"type": ["string", "number", "boolean"]}

Words = Annotated[list[str], BeforeValidator(_as_list), WithJsonSchema(_WORDS)]
"""One word or a list of them."""
Pace = Annotated[float, BeforeValidator(_as_pace), WithJsonSchema(_PACE)]
"""Logical seconds per wall second; `max` is 0: as fast as it goes."""
Scalar = Annotated[Any, BeforeValidator(_as_scalar), WithJsonSchema(_SCALAR)]
TargetLevel = Literal["debug", "info", "warning", "error", "off"]
"""Lines of this level and worse; `off`: none."""
SettingsByComponent = dict[str, dict[str, Any]]


class _Entry(BaseModel):
    model_config = ConfigDict(extra="forbid", use_attribute_docstrings=True, allow_inf_nan=False)


class RestartEntry(_Entry):
    """When a component that ended is started again."""

    when: Literal["never", "on-failure", "always"] = "on-failure"
    backoff_s: float = Field(0.1, ge=0.0, le=SECONDS_MAX)
    limit: int = Field(5, ge=0)
    window_s: float = Field(60.0, gt=0.0, le=SECONDS_MAX)


class ComponentEntry(_Entry):
    """A component."""

    use: str
    """Module with one component, or `module:Class`."""
    config: dict[str, Any] = {}
    channels: dict[str, str] = {}
    """Port to channel or pattern, where it is other than the class says."""
    stage: Words | None = None
    """Stages, where they are other than the class says."""
    providers: dict[str, str] = {}
    """Attribute of an aspect to the component that provides it, where several do."""
    rate_hz: float | None = Field(None, ge=0.0, le=RATE_MAX_HZ)
    """Iterations a second of a continuous component, where it is other than the class says."""
    needs: Words = []
    """Components that have to be ready before this one starts."""
    start: bool = True
    """Whether it starts with the run."""
    restart: RestartEntry = RestartEntry()
    ready_timeout_s: float | None = Field(None, gt=0.0, le=SECONDS_MAX)
    """Wall time in which it has to become ready; without it no limit."""
    stop_timeout_s: float | None = Field(None, gt=0.0, le=SECONDS_MAX)
    """Wall time in which its process has to end when it is stopped while the run goes on."""
    memory_limit_mb: float | None = Field(None, gt=0.0, le=1e9)
    """What it may take beyond what its process begins with."""


class RobotEntry(_Entry):
    """A namespace with all components of one or more templates."""

    use: Words
    values: dict[str, Scalar] = {}
    """What `{key}` stands for in channels and settings of the templates."""
    config: SettingsByComponent = {}


class LogEntry(_Entry):
    """Where lines of text go, and how many of them."""

    console: TargetLevel | None = None
    """Lines on the terminal."""
    file: TargetLevel | None = None
    """Lines in `fwk.log`, for people."""
    json_lines: TargetLevel | None = None
    """Lines in `fwk.log.jsonl`, for programs."""
    bus: TargetLevel | None = None
    """Lines on the public bus."""
    recording: TargetLevel | None = None
    """Lines in the recording."""
    syslog: TargetLevel | None = None
    """Lines in the system's log."""
    syslog_to: Annotated[str, AfterValidator(_as_syslog)] | None = None
    """Where that is: a socket's path, or an address and port."""
    file_mb: float | None = Field(None, ge=0.01, le=1e6)
    """Size at which a file is put aside and a new one begun."""
    files: int | None = Field(None, ge=1, le=1000)
    """How many are kept, with the one that is written."""
    lines_per_s: int | None = Field(None, ge=0)
    """Of one component, and of what one process prints; 0: any number."""


class RunsEntry(_Entry):
    """How many run directories stay when a run begins."""

    keep: int | None = Field(None, ge=0)
    """The newest so many; 0: any number."""
    size_gb: float | None = Field(None, ge=0.0, le=1e6)
    """How large they may be together; 0: any size."""


class RecordEntry(_Entry):
    """What the recording has besides all messages."""

    frames: Words | None = None
    """Channels of cameras whose frames are recorded, lossless: names or patterns such as `*/image`."""


class HostFile(_Entry):
    """What differs from machine to machine; the file beside a launch file may say only this."""

    period_s: float | None = Field(None, ge=0.001, le=10.0)
    """Logical time from tick to tick."""
    clock: Literal["simulated", "wall"] | None = None
    """`wall` keeps real time and goes on without the late."""
    speed: Pace | None = None
    """Logical seconds per second, or `max`."""
    seed: int | None = Field(None, ge=0)
    stage_time_s: float | None = Field(None, ge=0.0, le=SECONDS_MAX)
    """With `clock: wall`: how long a stage may take; 0: the period."""
    loop_time_s: float | None = Field(None, ge=0.0, le=SECONDS_MAX)
    """How long a tick should take; 0: the period."""
    loop_time_warnings: bool | None = None
    """Whether it is said when ticks take longer."""
    spare_channels: int | None = Field(None, ge=0, le=1000)
    """How many channels components can open while the run goes on."""
    public_url: str | None = None
    """Where ordinary LCM programs listen and write."""
    log: LogEntry = LogEntry()
    runs: RunsEntry = RunsEntry()
    record: RecordEntry = RecordEntry()
    outside: dict[str, str] = {}
    """Channels that other programs may write on the public bus: name to type."""
    hosts: dict[str, Words] = {}
    """Components that share a process: its name to patterns."""
    scoreboard: str | None = None
    """`module:function` that makes the display's headline."""
    video: str | None = None
    """`module:function` that draws a recording."""
    config: SettingsByComponent = {}
    """Settings by name pattern."""


class LaunchFile(HostFile):
    """A whole launch file."""

    include: Words = []
    name: str | None = None
    stages: list[str] | None = None
    templates: dict[str, dict[str, ComponentEntry]] = {}
    components: dict[str, ComponentEntry] = {}
    robots: dict[str, RobotEntry] = {}
