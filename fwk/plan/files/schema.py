"""Schema of launch files: keys and the values that they take."""

from collections import Counter
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    ValidatorFunctionWrapHandler,
    WithJsonSchema,
    WrapValidator,
    model_validator,
)

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN
from fwk.component.declaration import EVERY_MAX, RATE_MAX_HZ
from fwk.component.program import MODULE, program_class_name
from fwk.model.sections import LogPlan, RestartPolicy, RunsPlan

PACE_MAX = "max"
_PORTS = "reads", "writes", "serves", "calls"
"""Keys with the ports of a program."""
EVERY, OFFSET = "every", "offset"
"""Keys of a component that may stand among its settings too."""


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


def _whole_turns(value: Any, checked: ValidatorFunctionWrapHandler) -> Any:
    try:
        return checked(value)
    except ValidationError:
        raise ValueError(f"Input should be a whole number from 1 to {EVERY_MAX}") from None


_WORDS = {"anyOf": [{"type": "string"}, {"type": "array", "items": {"type": "string"}}]}
_PACE = {"anyOf": [{"type": "number", "minimum": SPEED_MIN, "maximum": SPEED_MAX}, {"const": PACE_MAX}]}
_SCALAR = {"type": ["string", "number", "boolean"]}

Words = Annotated[list[str], BeforeValidator(_as_list), WithJsonSchema(_WORDS)]
"""A word or a list of words."""
Pace = Annotated[float, BeforeValidator(_as_pace), WithJsonSchema(_PACE)]
"""Logical seconds per wall second; `max` is read as 0: as fast as possible."""
Scalar = Annotated[Any, BeforeValidator(_as_scalar), WithJsonSchema(_SCALAR)]
SettingsByComponent = dict[str, dict[str, Any]]


class _Entry(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


def _use_or_command(schema: dict[str, Any]) -> None:
    """Changes the JSON Schema of a component: `use` is required unless there is a `command`."""
    schema["required"] = [name for name in schema.get("required", ()) if name != "use"]
    schema["anyOf"] = [{"required": ["use"]}, {"required": ["command"]}]


class ComponentEntry(_Entry):
    """A component."""

    model_config = ConfigDict(json_schema_extra=_use_or_command)

    use: str
    """Module with one component, or `module:Class`."""
    command: Words = []
    """Instead of `use`: a program that carries out the iterations, and its arguments."""
    reads: dict[str, str] = {}
    """Ports of a program that read: name to message type."""
    writes: dict[str, str] = {}
    """Ports of a program that write: name to message type."""
    serves: dict[str, Words] = {}
    """Services that a program offers: name to the type of requests, or to the types of request and reply."""
    calls: dict[str, Words] = {}
    """Services that a program uses, likewise."""
    config: dict[str, Any] = {}
    channels: dict[str, str] = {}
    """Port to channel or pattern, where it differs from the class."""
    stage: Words | None = None
    """Stages, where they differ from those of the class."""
    every: Annotated[int, Field(strict=True, ge=1, le=EVERY_MAX), WrapValidator(_whole_turns)] | None = None
    """Iterates in one of `every` ticks, where the number differs from the class."""
    offset: Scalar | None = None
    """Shifts these ticks: it iterates when tick and offset have the same remainder modulo `every`."""
    providers: dict[str, str] = {}
    """Attribute of an aspect to the component that provides it, where several components do."""
    rate_hz: float | None = Field(None, ge=0.0, le=RATE_MAX_HZ)
    """Iterations per second of a continuous component, where they differ from the class."""
    needs: Words = []
    """Components that must be ready before this one starts."""
    start: bool = True
    """Whether it starts with the run."""
    restart: RestartPolicy = RestartPolicy()
    ready_timeout_s: float | None = Field(None, gt=0.0, le=SECONDS_MAX)
    """Wall time within which it must become ready; by default no limit."""
    stop_timeout_s: float | None = Field(None, gt=0.0, le=SECONDS_MAX)
    """Wall time within which its process must end when it is stopped during the run."""
    memory_limit_mb: float | None = Field(None, gt=0.0, le=1e9)
    """Memory that it may use beyond that of its process at the start."""

    @model_validator(mode="before")
    @classmethod
    def _program(cls, value: Any) -> Any:
        """Sets `use` to the class that runs a program."""
        if not isinstance(value, dict):
            return value
        groups = [value.get(key, {}) for key in _PORTS]
        if "command" not in value:
            if any(groups):
                raise ValueError(
                    "'reads', 'writes', 'serves' and 'calls' are for a program, with 'command'; "
                    "a class declares its ports itself"
                )
            return value
        if "use" in value:
            raise ValueError("both 'use' and 'command'; keep one of them")
        if not all(isinstance(ports, dict) for ports in groups):
            return {**value, "use": MODULE}  # the mistake is reported for that key
        names = Counter(name for ports in groups for name in ports)
        if twice := sorted(str(name) for name, count in names.items() if count > 1):
            keys = " and ".join(f"'{key}'" for key in _PORTS if twice[0] in value.get(key, {}))
            raise ValueError(f"'{twice[0]}' is in {keys}; give one of the ports another name")
        return {**value, "use": f"{MODULE}:{program_class_name(*groups)}"}


class RobotEntry(_Entry):
    """A namespace with all components of one or more templates."""

    use: Words
    values: dict[str, Scalar] = {}
    """Values of `{key}` in channels and settings of the templates."""
    config: SettingsByComponent = {}


class RecordEntry(_Entry):
    """Contents of a recording."""

    frames: Words | None = None
    """Channels of cameras whose frames are recorded, lossless: names or patterns such as `*/image`."""
    channels: Words | None = None
    """Channels that are recorded: names, patterns or namespaces; all by default. A replay needs all."""
    exclude: Words | None = None
    """Channels of these that are not recorded."""
    size_gb: float | None = Field(None, ge=0.0, le=1e6)
    """Size at which the recording ends while the run goes on; 0: no limit."""
    split_mb: float | None = Field(None, ge=0.0, le=1e6)
    """Size at which the recording goes on in a further file; 0: no limit."""
    split_s: float | None = Field(None, ge=0.0, le=SECONDS_MAX)
    """Logical time after which the recording goes on in a further file; 0: no limit."""
    compress: bool | None = None
    """Whether finished files of the recording are compressed."""


class HostFile(_Entry):
    """Keys of a host file, which a launch file may have as well."""

    period_s: float | None = Field(None, ge=0.001, le=10.0)
    """Logical time from tick to tick."""
    clock: Literal["simulated", "wall"] | None = None
    """`wall`: real time, which continues without late components."""
    speed: Pace | None = None
    """Logical seconds per second, or `max`."""
    seed: int | None = Field(None, ge=0)
    stage_time_s: float | None = Field(None, ge=0.0, le=SECONDS_MAX)
    """With `clock: wall`: longest duration of a stage; 0: the period."""
    loop_time_s: float | None = Field(None, ge=0.0, le=SECONDS_MAX)
    """Desired wall time of a tick; 0: the period."""
    loop_time_warnings: bool | None = None
    """Whether the log names ticks that take longer."""
    spare_channels: int | None = Field(None, ge=0, le=1000)
    """Number of channels that components can open during the run."""
    public_url: str | None = None
    """LCM URL of ordinary LCM programs."""
    log: LogPlan = LogPlan()
    runs: RunsPlan = RunsPlan()
    record: RecordEntry = RecordEntry()
    outside: dict[str, str] = {}
    """Channels that programs outside may write on the public bus: name to type."""
    hosts: dict[str, Words] = {}
    """Name of a process to patterns of the components that share it."""
    cores: Literal["any", "namespace"] | None = None
    """`namespace`: the processes of a namespace stay on one processor; namespaces take turns."""
    scoreboard: str | None = None
    """`module:function` that makes the display's headline."""
    video: str | None = None
    """`module:function` that draws a recording."""
    evaluation: str | None = None
    """`module:function` that plays the launch file and measures it."""
    config: SettingsByComponent = {}
    """Settings by name pattern."""
    shared: dict[str, Any] = {}
    """Settings that go to every component whose class has a setting of that name."""


class LaunchFile(HostFile):
    """A whole launch file."""

    include: Words = []
    name: str | None = None
    stages: list[str] | None = None
    templates: dict[str, dict[str, ComponentEntry]] = {}
    components: dict[str, ComponentEntry] = {}
    robots: dict[str, RobotEntry] = {}
