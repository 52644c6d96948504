"""What can be asked of a run, one model a request; a request is one JSON object on one line.

Every answer is a JSON object with `ok`; where that is false, `error` says what is wrong and what would be right.
"""

from typing import Annotated, Literal, TypeVar

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter, ValidationError

from fwk.clock import SECONDS_MAX, SPEED_MAX, SPEED_MIN

R = TypeVar("R")
Action = Literal["start", "stop", "restart", "reload", "load", "unload", "kill"]
Names = Annotated[list[Annotated[str, Field(max_length=200)]], Field(max_length=1000)]


class _Request(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Run(_Request):
    """Which run is this: plan, file, run directory, process, ports."""

    verb: Literal["run"]


class Status(_Request):
    """The run and its components; of all, or of those that the patterns mean."""

    verb: Literal["status"]
    names: Names = []


class Times(_Request):
    """Histograms of wall time: of ticks, stages and components."""

    verb: Literal["times"]


class Steer(_Request):
    """Another desired state for some components; answered when they have it."""

    verb: Literal["steer"]
    action: Action
    names: Names
    force: bool = False
    """Of `unload`: who needs the components is unloaded too."""


class TakePlace(_Request):
    """The process that asks takes a component's place in the loop; answered at its turn, with what it needs."""

    verb: Literal["take_place"]
    name: str
    held: bool = False
    """Whether a debugger has it: then nobody hurries it."""


def _possible(speed: float) -> float:
    if 0.0 < speed < SPEED_MIN:
        raise ValueError(f"it should be 0, or from {SPEED_MIN:g} to {SPEED_MAX:g}")
    return speed


class Clock(_Request):
    """Simulated time stands still, goes on, goes on for some ticks, or at another speed; answered when it does."""

    verb: Literal["pause", "resume", "step", "speed"]
    ticks: int = Field(1, ge=1)
    """To step."""
    speed: Annotated[float, Field(ge=0.0, le=SPEED_MAX), AfterValidator(_possible)] | None = None
    """Logical seconds per wall second, 0: as fast as it goes; without it the speed is only told."""


class Settings(_Request):
    """Every effective setting with its origin, type and meaning."""

    verb: Literal["settings"]
    names: Names = []


class SetSettings(_Request):
    """New values as `NAME.SETTING=VALUE`; answered when the components have them, `check`: only whether they could."""

    verb: Literal["set"]
    changes: Annotated[list[str], Field(max_length=1000)]  # as long as a request may be
    check: bool = False
    origin: str = Field("fwk config set", max_length=500)


class WatchSettings(_Request):
    """From now on an answer for each change of a setting."""

    verb: Literal["watch_settings"]
    names: Names = []


class Common(_Request):
    """The common interface of one component."""

    verb: Literal["state", "period", "time_awake", "parameters", "kill"]
    name: str


class Note(_Request):
    """A line for the run's log, at the tick that is now."""

    verb: Literal["note"]
    text: str = Field(min_length=1, max_length=4000)
    level: Literal["info", "warning"] = "info"


class Channels(_Request):
    """Asked of the gateway: all channels with type, writer, readers, newest sequence number, tick and time."""

    verb: Literal["channels"]


class Show(_Request):
    """Asked of the gateway: a channel's newest message."""

    verb: Literal["show"]
    channel: str


class Watch(_Request):
    """Asked of the gateway: a channel's newest message, and from now on each new one."""

    verb: Literal["watch"]
    channel: str


class Call(_Request):
    """Asked of the gateway: a command for a component; an answer at once and for each answer of the component."""

    verb: Literal["call"]
    name: str
    data: str
    """The command's message, encoded, in hexadecimal digits; header and expiry are filled in."""
    expires_s: float = Field(gt=0.0, allow_inf_nan=False, le=SECONDS_MAX)
    """Logical time after which it is not begun any more."""


SupervisorRequest = (
    Run | Status | Times | Steer | Clock | TakePlace | Settings | SetSettings | WatchSettings | Common | Note
)
GatewayRequest = Channels | Show | Watch | Call
to_supervisor: TypeAdapter[SupervisorRequest] = TypeAdapter(Annotated[SupervisorRequest, Field(discriminator="verb")])
to_gateway: TypeAdapter[GatewayRequest] = TypeAdapter(Annotated[GatewayRequest, Field(discriminator="verb")])


class RequestError(Exception):
    """A request that cannot be understood or fulfilled; says why and what would be right."""


def parsed(adapter: TypeAdapter[R], line: bytes) -> R:
    """Reads a request.

    Raises:
        RequestError: it is none.
    """
    try:
        return adapter.validate_json(line)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        place = ".".join(map(str, first["loc"]))
        raise RequestError(f"no request: {f'{place}: ' if place else ''}{first['msg']}") from error
