"""Requests to a run, one model each; a request is one JSON object on one line.

Every answer is a JSON object with `ok`; where that is false, `error` names the mistake and the correction.
"""

from typing import Annotated, Literal, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN

R = TypeVar("R")
NESTED_MAX = 32
"""Deepest nesting of lists and mappings in a new value."""
Action = Literal["start", "stop", "restart", "reload", "load", "unload", "kill"]
Names = Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=1000)]


class _Request(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True, defer_build=True)


class Run(_Request):
    """Asks for the run's identity: plan, file, run directory, process, ports."""

    verb: Literal["run"]


class Status(_Request):
    """Asks for the state of the run and of its components, or of those that match the patterns."""

    verb: Literal["status"]
    names: Names = []


class Times(_Request):
    """Asks for histograms of wall time: of ticks, stages and components."""

    verb: Literal["times"]


class Steer(_Request):
    """Changes the desired state of components; answered when they have it."""

    verb: Literal["steer"]
    action: Action
    names: Names
    force: bool = False
    """`unload` also unloads the dependents."""


class TakePlace(_Request):
    """Attaches the process of the client as a component's host; answered at its turn, with what it needs."""

    verb: Literal["take_place"]
    name: str
    held: bool = False
    """Whether a debugger holds the process, so that no time-out applies."""


def refuse_deep_nesting(change: str) -> str:
    """Refuses deeply nested values before the YAML reader, which takes quadratic time, sees them."""
    depth = 0
    for letter in change:
        depth += (letter in "[{") - (letter in "]}")
        if depth > NESTED_MAX:
            raise ValueError(f"a value may be nested {NESTED_MAX} deep, this one is deeper")
    return change


def _possible(speed: float) -> float:
    if 0.0 < speed < SPEED_MIN:
        raise ValueError(f"it should be 0, or from {SPEED_MIN:g} to {SPEED_MAX:g}")
    return speed


class SetClock(_Request):
    """Pauses, resumes or steps simulated time, or sets its speed; answered after the effect."""

    verb: Literal["pause", "resume", "step", "speed"]
    ticks: int = Field(1, ge=1)
    """Number of ticks to step."""
    speed: Annotated[float, Field(ge=0.0, le=SPEED_MAX), AfterValidator(_possible)] | None = None
    """Logical seconds per wall second, 0: as fast as possible; without it, the speed is only reported."""


class Settings(_Request):
    """Asks for every effective setting with its origin, type and meaning."""

    verb: Literal["settings"]
    names: Names = []


class SetSettings(_Request):
    """Sets values, `NAME.SETTING=VALUE` each; answered when the components have them. `check` only checks them."""

    verb: Literal["set"]
    changes: Annotated[list[Annotated[str, AfterValidator(refuse_deep_nesting)]], Field(max_length=1000)]
    check: bool = False
    origin: str = Field("fwk config set", max_length=500)


class WatchSettings(_Request):
    """Asks for an answer at each change of a setting from now on."""

    verb: Literal["watch_settings"]
    names: Names = []


class Common(_Request):
    """Uses the common interface of one component."""

    verb: Literal["state", "period", "time_awake", "parameters", "kill"]
    name: str


class Note(_Request):
    """Adds a line to the run's log, at the current tick."""

    verb: Literal["note"]
    text: str = Field(min_length=1, max_length=4000)
    level: Literal["info", "warning"] = "info"


class Channels(_Request):
    """Asks the gateway for all channels with type, writer, readers, newest sequence number, tick and time."""

    verb: Literal["channels"]


class Show(_Request):
    """Asks the gateway for a channel's newest message."""

    verb: Literal["show"]
    channel: str


class Watch(_Request):
    """Asks the gateway for a channel's newest message, and from now on for each new one."""

    verb: Literal["watch"]
    channel: str


class Newest(_Request):
    """Asks the gateway for the newest messages of channels, encoded, as far as they are newer than the known ones."""

    verb: Literal["newest"]
    known: Annotated[dict[str, int], Field(max_length=1000)]
    """Channel to the sequence number that the tool has; 0: none."""


class CallService(_Request):
    """Sends a command to a component through the gateway; answered at once and for each answer of the component."""

    verb: Literal["call"]
    name: str
    data: str
    """The command's message, encoded, in hexadecimal digits; header and expiry are filled in."""
    expires_s: float = Field(gt=0.0, allow_inf_nan=False, le=SECONDS_MAX)
    """Logical time after which the command does not begin any more."""


SupervisorRequest = (
    Run | Status | Times | Steer | SetClock | TakePlace | Settings | SetSettings | WatchSettings | Common | Note
)
GatewayRequest = Channels | Show | Watch | Newest | CallService
_LATER = ConfigDict(defer_build=True)  # validators are built for the first request: most runs never get one
to_supervisor: TypeAdapter[SupervisorRequest] = TypeAdapter(
    Annotated[SupervisorRequest, Field(discriminator="verb")], config=_LATER
)
to_gateway: TypeAdapter[GatewayRequest] = TypeAdapter(
    Annotated[GatewayRequest, Field(discriminator="verb")], config=_LATER
)


class RequestError(Exception):
    """A request that cannot be read or fulfilled; the text gives the reason and the correction."""


def parsed(adapter: TypeAdapter[R], line: bytes) -> R:
    """Reads a request.

    Raises:
        RequestError: the line is not a request.
    """
    try:
        return adapter.validate_json(line)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place, said = ".".join(map(str, first["loc"])), first["msg"].removeprefix("Value error, ")
        raise RequestError(f"not a request: {f'{place}: ' if place else ''}{said}") from error
