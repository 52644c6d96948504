"""The base class of components, and what a component's class says it wants."""

import typing
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar, Literal, get_args, get_origin

import numpy as np

from fwk import messages
from fwk.aspects.blackboard import ChannelDefault, Reads, ReadsEach, Writes, WritesEach
from fwk.aspects.commands import Commands
from fwk.aspects.logging import Logger
from fwk.aspects.main_loop import MainLoop
from fwk.aspects.plugins import PluginControl
from fwk.aspects.provided import Aspect
from fwk.aspects.rpc import Calls, CallsEach, Serves
from fwk.aspects.sending import Sends, SendsEach
from fwk.aspects.vision import Image, ImagesEach, VisionMaster
from fwk.clock import Clock, TimeSource
from fwk.config import LOG_LEVEL, Config, with_log_level
from lcmtypes.core import acknowledgement_t
from lcmtypes.robot import frame_t

DEFAULT_STAGES = (
    "pre_loop",
    "sensor_acquire",
    "sensor_prepare",
    "sensor_process",
    "worldstate",
    "think",
    "skill",
    "act",
    "act_exec",
    "post_loop",
)

RATE_MAX_HZ = 10_000


class Component:
    """A unit of deployment. What it wants stands in annotated lines and is there before `init`.

    | annotation | gives |
    | --- | --- |
    | `ball: Reads[ball_t]` | newest value and all since the last iteration of `<namespace>/ball` |
    | `ball: Reads[ball_t] = channel(history=20)` | besides, the newest 20 in `self.ball.history` |
    | `pose: Writes[pose_t]` | the one writer of `<namespace>/pose` |
    | `ReadsEach[...]`, `WritesEach[...]` | many instances of an interface, by namespace |
    | `kick: Commands[kick_t]` | the commands `<namespace>/kick`, to carry out; one such component each |
    | `kick: Sends[kick_t]` | sends them, and sees what becomes of each |
    | `path: Serves[path_request_t, path_t]`, `path: Calls[...]` | requests with a typed reply, to answer; to ask |
    | `SendsEach[...]`, `CallsEach[...]` | to many of those who carry them out, by namespace |
    | `image: Image`, `image: VisionMaster` | frames of a camera, to read or to give out |
    | `image: ImagesEach` | frames of many cameras, by namespace |
    | `config: MyConfig` | checked settings |
    | `clock: Clock` | logical time |
    | `log: Logger` | the system's log |
    | `rng: np.random.Generator` | random numbers, seeded from the run's seed and the component's name |
    | `time_source: TimeSource` | says when the next tick happens; one a system |
    | `main_loop: MainLoop` | takes over the main loop, and gives it back; one at a time |
    | `plugins: PluginControl` | starts, stops and exchanges other components |
    | `tf: Transforms`, any class derived from `Aspect` | what another component provides |
    """

    stage: ClassVar[str | tuple[str, ...]]
    provides: ClassVar[type[Aspect] | tuple[type[Aspect], ...]] = ()
    """Aspects that others get from this component."""
    rate_hz: ClassVar[float | None] = None
    """Instead of a stage: iterations a second of a continuous component; 0: again when there is something newer."""
    name: str
    """Full name: `cyan1/omni_ball`."""
    changed_settings: frozenset[str] = frozenset()
    """What the newest change of settings has changed; dotted names, for `config_changed`."""

    @classmethod
    def preload(cls, config: Any) -> None:
        """Called before processes are forked, once for each setting of the class: make here what all can share.

        Fill a cache with tables that are never written to; the component's `init` finds them there. Nothing may depend
        on it: a component started by hand or in a test has to do without.
        """

    def init(self) -> None:
        """Called once before the first iteration; an exception means that the component does not start."""

    def loop(self) -> None:
        """One iteration."""

    def config_changed(self) -> None:
        """Called between two iterations when settings were changed; `self.config` has the new ones.

        What `init` has made of the old ones has to be made anew here; `self.changed_settings` says which they are.
        """

    def finalize(self) -> None:
        """Called once after the last iteration, when the component is stopped or the run ends.

        What it writes is seen as that of an iteration if the run goes on: an actuator's driver leaves it stopped.
        """


class DeclarationError(Exception):
    """A component's class wants something that does not exist; says class, attribute and what would be right."""


PortKind = Literal[
    "reads",
    "writes",
    "reads_each",
    "writes_each",
    "image",
    "images_each",
    "vision_master",
    "commands",
    "serves",
    "sends",
    "calls",
    "sends_each",
    "calls_each",
]
_PORT_KINDS: dict[Any, PortKind] = {
    Reads: "reads",
    Writes: "writes",
    ReadsEach: "reads_each",
    WritesEach: "writes_each",
    Commands: "commands",
    Serves: "serves",
    Sends: "sends",
    Calls: "calls",
    SendsEach: "sends_each",
    CallsEach: "calls_each",
}
_IMAGE_KINDS: dict[Any, PortKind] = {Image: "image", ImagesEach: "images_each", VisionMaster: "vision_master"}


@dataclass(frozen=True)
class Port:
    """One channel wish: `attribute: Reads[message_type]`, and the channel the class names for it.

    A port for commands has a channel of each sender, and one for the answers, which are of `reply_type`.
    """

    attribute: str
    kind: PortKind
    message_type: type[messages.Message]
    channel: str
    reply_type: type[messages.Message] | None = None
    history: int = 0
    """How many of the newest messages a reader keeps; 0: the newest only."""

    @property
    def writes(self) -> bool:
        """Whether the component is the writer."""
        return self.kind in ("writes", "writes_each", "vision_master")

    @property
    def each(self) -> bool:
        """Whether it stands for many instances."""
        return self.kind in ("reads_each", "writes_each", "sends_each", "calls_each", "images_each")

    @property
    def owns(self) -> bool:
        """Whether the component carries out the commands or answers the requests."""
        return self.kind in ("commands", "serves")

    @property
    def sends(self) -> bool:
        """Whether the component sends commands or requests."""
        return self.kind in ("sends", "calls", "sends_each", "calls_each")

    @property
    def images(self) -> bool:
        """Whether frames lie in a shared-memory ring beside the channel."""
        return self.kind in ("image", "images_each", "vision_master")


@dataclass(frozen=True)
class Declaration:
    """Everything a component's class says about itself."""

    component: type[Component]
    stages: tuple[str, ...]
    ports: tuple[Port, ...]
    config: type[Config]
    """With `log_level`, which every component has."""
    aspects: dict[str, str] = field(default_factory=dict)
    """Attribute to aspect name: clock, log, rng, time_source, main_loop, plugins."""
    asks: dict[str, type[Aspect]] = field(default_factory=dict)
    """Attribute to an aspect that another component provides; its own attributes are `attribute.own` above."""
    provides: tuple[type[Aspect], ...] = ()
    rate_hz: float | None = None
    """Of a continuous component; None: it takes part in stages."""


_ASPECTS: dict[Any, str] = {
    Clock: "clock",
    Logger: "log",
    np.random.Generator: "rng",
    TimeSource: "time_source",
    MainLoop: "main_loop",
    PluginControl: "plugins",
}


def declaration(component: type[Component]) -> Declaration:
    """Reads a component's class.

    Raises:
        DeclarationError: no stage, or an annotation that is no aspect.
    """
    where = f"{component.__module__}.{component.__qualname__}"
    stages, rate_hz = getattr(component, "stage", None) or (), component.rate_hz
    if stages and rate_hz is not None:
        raise DeclarationError(f"{where}: a stage and a rate; keep 'stage', or 'rate_hz' if it is to be continuous")
    if not stages and rate_hz is None:
        raise DeclarationError(f'{where}: no stage; say for example: stage = "think"')
    hints = _hints(component, where)
    ports: list[Port] = []
    aspects, asks, config = {}, {}, Config
    for attribute, wish in hints.items():
        if attribute in ("stage", "rate_hz", "name", "changed_settings", "provides") or attribute.startswith("_"):
            continue
        default = getattr(component, attribute, None)
        if get_origin(wish) in _PORT_KINDS:
            ports.append(_port(where, attribute, _PORT_KINDS[get_origin(wish)], get_args(wish), default))
        elif wish in _IMAGE_KINDS:
            ports.append(_port(where, attribute, _IMAGE_KINDS[wish], (frame_t,), default))
        elif wish in _ASPECTS:
            aspects[attribute] = _ASPECTS[wish]
        elif isinstance(wish, type) and issubclass(wish, Aspect):
            asks[attribute] = wish
            inner_ports, inner_aspects = _inside(wish, attribute)
            ports += inner_ports
            aspects |= inner_aspects
        elif isinstance(wish, type) and issubclass(wish, Config):
            if attribute != "config":
                raise DeclarationError(f"{where}.{attribute}: settings are called 'config'")
            if LOG_LEVEL in wish.model_fields:
                raise DeclarationError(f"{where}: every component has a setting '{LOG_LEVEL}'; call its own otherwise")
            config = wish
        elif get_origin(wish) is not ClassVar and default is None:
            raise DeclarationError(
                f"{where}.{attribute}: {getattr(wish, '__name__', wish)} is no aspect; "
                f"annotate with Reads, Writes, ReadsEach, WritesEach, Commands, Sends, SendsEach, Serves, Calls, "
                "CallsEach, Image, ImagesEach, VisionMaster, a Config, Clock, Logger, "
                "numpy.random.Generator, TimeSource, MainLoop or an Aspect, and set plain attributes in init()"
            )
    if rate_hz is not None:
        _check_continuous(where, rate_hz, ports, aspects)
    return Declaration(
        component,
        (stages,) if isinstance(stages, str) else tuple(stages),
        tuple(ports),
        with_log_level(config),
        aspects,
        asks,
        _provided(component, where, ports),
        rate_hz,
    )


def _hints(kind: type, where: str) -> dict[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except (NameError, TypeError, AttributeError) as error:
        raise DeclarationError(f"{where}: an annotation cannot be read: {error}") from error


def _inside(aspect: type[Aspect], attribute: str) -> tuple[list[Port], dict[str, str]]:
    """Ports and aspects of a provided aspect, as those of the component that asks for it."""
    where = f"{aspect.__module__}.{aspect.__qualname__}"
    ports, aspects = [], {}
    for own, wish in _hints(aspect, where).items():
        default, dotted = getattr(aspect, own, None), f"{attribute}.{own}"
        if get_origin(wish) in (Reads, ReadsEach):
            port = _port(where, own, _PORT_KINDS[get_origin(wish)], get_args(wish), default)
            ports.append(replace(port, attribute=dotted))
        elif wish is Image:
            ports.append(replace(_port(where, own, "image", (frame_t,), default), attribute=dotted))
        elif wish in (Clock, Logger):
            aspects[dotted] = _ASPECTS[wish]
        elif not own.startswith("_") and get_origin(wish) is not ClassVar and default is None:
            raise DeclarationError(
                f"{where}.{own}: an aspect that a component provides has Reads, ReadsEach, Image, Clock and Logger, "
                f"not {getattr(wish, '__name__', wish)}; what a component writes stands in its own class"
            )
    return ports, aspects


def _provided(component: type[Component], where: str, ports: list[Port]) -> tuple[type[Aspect], ...]:
    """What a class says that it provides, if it writes what that takes."""
    said = component.provides if isinstance(component.provides, tuple) else (component.provides,)
    for aspect in said:
        if not (isinstance(aspect, type) and issubclass(aspect, Aspect)):
            raise DeclarationError(f"{where}: it provides {aspect!r}, which is no aspect; derive it from fwk.Aspect")
        written = {port.attribute: port for port in ports if port.kind in ("writes", "vision_master")}
        for port in _inside(aspect, "")[0]:
            own = port.attribute[1:]
            if not port.each and (own not in written or written[own].message_type is not port.message_type):
                wish = "VisionMaster" if port.images else f"Writes[{port.message_type.__name__}]"
                raise DeclarationError(
                    f"{where}: it provides {aspect.__name__}, which reads '{own}' of it; add {own}: {wish}"
                )
    return said


def _check_continuous(where: str, rate_hz: Any, ports: list[Port], aspects: dict[str, str]) -> None:
    if isinstance(rate_hz, bool) or not isinstance(rate_hz, int | float) or not 0 <= rate_hz <= RATE_MAX_HZ:
        raise DeclarationError(f"{where}: rate_hz is {rate_hz!r}; it should be a number from 0 to {RATE_MAX_HZ}")
    for port in ports:
        if port.images:
            raise DeclarationError(
                f"{where}.{port.attribute}: a continuous component has no frames: their ring goes on without it; "
                "give it a stage, or let a component with a stage look"
            )
    for attribute, aspect in aspects.items():
        if aspect == "time_source":
            raise DeclarationError(f"{where}.{attribute}: a continuous component is no time source; give it a stage")


def _port(where: str, attribute: str, kind: PortKind, types: tuple[Any, ...], default: Any) -> Port:
    for message_type in types:
        if not hasattr(message_type, "_get_packed_fingerprint"):
            raise DeclarationError(f"{where}.{attribute}: {message_type!r} is no LCM type; import it from lcmtypes")
        if not messages.has_header(message_type):
            name = messages.type_name(message_type)
            raise DeclarationError(f"{where}.{attribute}: {name} does not begin with 'core.header_t header;'")
    given = default if isinstance(default, ChannelDefault) else ChannelDefault("")
    made = Port(attribute, kind, types[0], given.name or attribute, history=given.history)
    if given.history < 0 or (given.history and kind not in ("reads", "reads_each")):
        wrong = "a history has at least 1 message" if given.history < 0 else "only Reads and ReadsEach keep a history"
        raise DeclarationError(f"{where}.{attribute}: history={given.history}: {wrong}")
    if made.owns or made.sends:
        made = replace(made, reply_type=types[1] if len(types) > 1 else acknowledgement_t)
        _check_second(where, attribute, types[0], "command", "command")
        _check_second(where, attribute, made.reply_type, "answer", "reply")
    if made.each and "*" not in made.channel:
        made = replace(made, channel=f"*/{made.channel}")
    return made


def _check_second(where: str, attribute: str, message_type: Any, member: str, what: str) -> None:
    if not messages.has_second(message_type, member, f"core.{member}_t"):
        name = messages.type_name(message_type)
        raise DeclarationError(
            f"{where}.{attribute}: {name} is no {what}: its second member is not 'core.{member}_t {member};'"
        )
