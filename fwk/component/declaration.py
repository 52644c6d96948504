"""What a component's class says it wants: its stages or rate, ports, settings and aspects."""

import typing
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from functools import cache
from inspect import get_annotations
from typing import Any, ClassVar, get_args, get_origin

import numpy as np

from fwk.clock import Clock, TimeSource
from fwk.component.aspect import Aspect
from fwk.component.blackboard import Blackboard
from fwk.component.channels import Reads, ReadsEach
from fwk.component.component import Component
from fwk.component.config import LOG_LEVEL, Config, with_log_level
from fwk.component.images import Image
from fwk.component.log import Logger
from fwk.component.log_lines import LogLines
from fwk.component.main_loop import MainLoop
from fwk.component.plugins import PluginControl
from fwk.component.port import IMAGE_KINDS, PORT_KINDS, DeclarationError, Port, declared_port
from fwk.model.names import LINES
from lcmtypes.core import frame_t, log_t

RATE_MAX_HZ = 10_000
_METHODS = ("init", "loop", "finalize", "config_changed")
_ALIKE = 0.8  # similarity of a misspelt method's name: `lop` is one, `look` is a method of its own
_OF_ALL = frozenset(get_annotations(Component))
"""Annotated attributes that every component has; they are no aspects."""


@dataclass(frozen=True)
class Declaration:
    """Everything a component's class says about itself."""

    component: type[Component]
    stages: tuple[str, ...]
    ports: tuple[Port, ...]
    config: type[Config]
    """With `log_level`, which every component has."""
    aspects: dict[str, str] = field(default_factory=dict)
    """Attribute to aspect name: clock, log, rng, time_source, main_loop, plugins, blackboard."""
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
    Blackboard: "blackboard",
}


def declaration(component: type[Component]) -> Declaration:
    """Reads a component's class, once.

    Raises:
        DeclarationError: no stage, or an annotation that is no aspect.
    """
    return _read(component)  # type: ignore[arg-type]  # mypy takes classes for something that cannot be hashed


@cache
def _read(component: type[Component]) -> Declaration:
    where = f"{component.__module__}.{component.__qualname__}"
    stages, rate_hz = _stages(component, where), component.rate_hz
    if stages and rate_hz is not None:
        raise DeclarationError(f"{where}: a stage and a rate; keep 'stage', or 'rate_hz' if it is to be continuous")
    if not stages and rate_hz is None:
        raise DeclarationError(f'{where}: no stage; say for example: stage = "think"')
    _check_methods(component, where)
    hints = _hints(component, where)
    ports: list[Port] = []
    aspects, asks, config = {}, {}, Config
    for attribute, wish in hints.items():
        if attribute in _OF_ALL or attribute.startswith("_"):
            continue
        if hasattr(Component, attribute) and attribute != "config":
            raise DeclarationError(f"{where}.{attribute}: every component has '{attribute}'; call this one otherwise")
        default = getattr(component, attribute, None)
        if get_origin(wish) in PORT_KINDS:
            ports.append(declared_port(where, attribute, PORT_KINDS[get_origin(wish)], get_args(wish), default))
        elif wish in IMAGE_KINDS:
            ports.append(declared_port(where, attribute, IMAGE_KINDS[wish], (frame_t,), default))
        elif wish is LogLines:
            ports.append(Port(attribute, "lines", log_t, LINES))
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
        elif wish in PORT_KINDS:
            name = wish.__name__
            types = "request_t, reply_t" if name.startswith(("Serves", "Calls")) else "message_t"
            right = f"name its type: {attribute}: {name}[{types}]"
            raise DeclarationError(f"{where}.{attribute}: {name} of which messages? {right}")
        elif get_origin(wish) is not ClassVar and default is None:
            raise DeclarationError(
                f"{where}.{attribute}: {getattr(wish, '__name__', wish)} is not an aspect; "
                "annotate with Reads, Writes, ReadsEach, WritesEach, Commands, CommandsEach, Sends, SendsEach, Serves, "
                "ServesEach, Calls, CallsEach, Image, ImagesEach, VisionMaster, a Config, Clock, Logger, LogLines, "
                "numpy.random.Generator, TimeSource, MainLoop, PluginControl, Blackboard or an Aspect, and set plain "
                "attributes in init()"
            )
    if rate_hz is not None:
        _check_continuous(where, rate_hz, ports, aspects)
    return Declaration(
        component,
        stages,
        tuple(ports),
        with_log_level(config),
        aspects,
        asks,
        _provided(component, where, ports),
        rate_hz,
    )


def _stages(component: type[Component], where: str) -> tuple[str, ...]:
    said = getattr(component, "stage", None) or ()
    stages = (said,) if isinstance(said, str) else said
    if not isinstance(stages, tuple | list) or not all(isinstance(stage, str) for stage in stages):
        raise DeclarationError(f'{where}: stage is {said!r}; it should be text such as "think", or a tuple of it')
    return tuple(stages)


def _check_methods(component: type[Component], where: str) -> None:
    """Finds a method that is called almost like one of `Component`, such as `lop`, in a class without that one."""
    for base in component.__mro__[: component.__mro__.index(Component)]:
        for name, value in vars(base).items():
            if not callable(value) or name.startswith("_") or hasattr(Component, name):
                continue
            near = get_close_matches(name.lower(), _METHODS, 1, _ALIKE)
            if near and getattr(component, near[0]) is getattr(Component, near[0]):
                raise DeclarationError(
                    f"{where}.{name}: the framework calls no method '{name}'; did you mean '{near[0]}'?"
                )


def _hints(kind: type, where: str) -> dict[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except (NameError, TypeError, AttributeError, SyntaxError) as error:
        raise DeclarationError(f"{where}: an annotation cannot be read: {error}") from error


def _inside(aspect: type[Aspect], attribute: str) -> tuple[list[Port], dict[str, str]]:
    """Ports and aspects of a provided aspect, as those of the component that asks for it."""
    where = f"{aspect.__module__}.{aspect.__qualname__}"
    ports, aspects = [], {}
    for own, wish in _hints(aspect, where).items():
        default, dotted = getattr(aspect, own, None), f"{attribute}.{own}"
        if get_origin(wish) in (Reads, ReadsEach):
            port = declared_port(where, own, PORT_KINDS[get_origin(wish)], get_args(wish), default)
            ports.append(replace(port, attribute=dotted))
        elif wish is Image:
            ports.append(replace(declared_port(where, own, "image", (frame_t,), default), attribute=dotted))
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
