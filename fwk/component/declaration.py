"""Declaration of a component's class: stages or rate, ports, settings and aspects."""

import inspect
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
from fwk.component.component import Component
from fwk.component.config import LOG_LEVEL, Config, with_log_level
from fwk.component.each import Each
from fwk.component.log import Logger
from fwk.component.log_lines import LogLines
from fwk.component.main_loop import MainLoop
from fwk.component.plugins import PluginControl
from fwk.component.port import DeclarationError, Port, port_of
from fwk.model.names import LINES
from lcmtypes.core import log_t

RATE_MAX_HZ = 10_000
EVERY_MAX = 1_000_000
_METHODS = ("init", "loop", "finalize", "config_changed")
_ALIKE = 0.8  # similarity from which a method's name counts as misspelt: `lop` does, `look` does not
_OF_ALL = frozenset(get_annotations(Component))
"""Annotated attributes that every component has and that are not aspects."""


@dataclass(frozen=True)
class Declaration:
    """Everything that a component's class declares."""

    component: type[Component]
    stages: tuple[str, ...]
    ports: tuple[Port, ...]
    config: type[Config]
    """The class of its settings, with `log_level`, which every component has."""
    aspects: dict[str, str] = field(default_factory=dict)
    """Attribute to aspect name: clock, log, rng, time_source, main_loop, plugins, blackboard."""
    asks: dict[str, type[Aspect]] = field(default_factory=dict)
    """Attribute to an aspect that another component provides; ports and aspects of it have dotted names above."""
    provides: tuple[type[Aspect], ...] = ()
    rate_hz: float | None = None
    """Rate of a continuous component; None: the component iterates in stages."""
    every: int = 1
    """Iterates in the ticks with `tick % every == offset % every`."""
    offset: int = 0


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
    """Reads a component's class; the result is cached.

    Raises:
        DeclarationError: the class declares no stage or something invalid.
    """
    return _read(component)  # type: ignore[arg-type]  # mypy does not take classes for hashable


@cache
def _read(component: type[Component]) -> Declaration:
    where = f"{component.__module__}.{component.__qualname__}"
    stages, rate_hz = _stages(component, where), component.rate_hz
    if stages and rate_hz is not None:
        raise DeclarationError(f"{where}: both a stage and a rate; keep 'stage', or 'rate_hz' to be continuous")
    if not stages and rate_hz is None:
        raise DeclarationError(f'{where}: no stage; write for example: stage = "think"')
    _check_methods(component, where)
    _check_calls(component, where)
    hints = _hints(component, where)
    ports: list[Port] = []
    aspects, asks, config = {}, {}, Config
    for attribute, annotation in hints.items():
        if attribute in _OF_ALL or attribute.startswith("_"):
            continue
        if hasattr(Component, attribute) and attribute != "config":
            raise DeclarationError(f"{where}.{attribute}: every component has '{attribute}'; choose another name")
        default = getattr(component, attribute, None)
        if port := port_of(where, attribute, annotation, default):
            ports.append(port)
        elif annotation is LogLines:
            ports.append(Port(attribute, "lines", log_t, LINES))
        elif annotation in _ASPECTS:
            aspects[attribute] = _ASPECTS[annotation]
        elif isinstance(annotation, type) and issubclass(annotation, Aspect):
            asks[attribute] = annotation
            inner_ports, inner_aspects = _inside(annotation, attribute)
            ports += inner_ports
            aspects |= inner_aspects
        elif isinstance(annotation, type) and issubclass(annotation, Config):
            if attribute != "config":
                raise DeclarationError(f"{where}.{attribute}: the attribute for settings has to be called 'config'")
            if LOG_LEVEL in annotation.model_fields:
                raise DeclarationError(f"{where}: every component has a setting '{LOG_LEVEL}'; choose another name")
            config = annotation
        elif get_origin(annotation) is not ClassVar and default is None:
            raise DeclarationError(
                f"{where}.{attribute}: {_name(annotation)} is not an aspect; "
                "annotate with Reads, Writes, Serves, Calls, Image, Each, VisionMaster, a Config, Clock, Logger, "
                "LogLines, numpy.random.Generator, TimeSource, MainLoop, PluginControl, Blackboard or an Aspect, and "
                "set plain attributes in init()"
            )
    if rate_hz is not None:
        _check_continuous(where, rate_hz, ports, aspects)
    _check_every(component, where, aspects)
    return Declaration(
        component,
        stages,
        tuple(ports),
        with_log_level(config),
        aspects,
        asks,
        _provided(component, where, ports),
        rate_hz,
        component.every,
        component.offset,
    )


def _stages(component: type[Component], where: str) -> tuple[str, ...]:
    declared = getattr(component, "stage", None) or ()
    stages = (declared,) if isinstance(declared, str) else declared
    if not isinstance(stages, tuple | list) or not all(isinstance(stage, str) for stage in stages):
        raise DeclarationError(
            f'{where}: stage is {declared!r}; it should be text such as "think", or a tuple of texts'
        )
    return tuple(stages)


def _check_methods(component: type[Component], where: str) -> None:
    """Refuses a method whose name looks like a misspelt method of `Component`, such as `lop`."""
    for base in component.__mro__[: component.__mro__.index(Component)]:
        for name, value in vars(base).items():
            if not callable(value) or name.startswith("_") or hasattr(Component, name):
                continue
            near = get_close_matches(name.lower(), _METHODS, 1, _ALIKE)
            if near and getattr(component, near[0]) is getattr(Component, near[0]):
                raise DeclarationError(
                    f"{where}.{name}: the framework calls no method '{name}'; did you mean '{near[0]}'?"
                )


def _check_calls(component: type[Component], where: str) -> None:
    """Refuses methods that the framework cannot call: with further arguments, as coroutines or as generators."""
    for name in ("__init__", *_METHODS):
        method = getattr(component, name)
        if method in (getattr(Component, name), object.__init__):
            continue
        right = f"write: def {name}(self) -> None"
        if inspect.iscoroutinefunction(method) or inspect.isasyncgenfunction(method):
            raise DeclarationError(f"{where}.{name}: the framework awaits no coroutine; {right}")
        if inspect.isgeneratorfunction(method):
            raise DeclarationError(f"{where}.{name}: 'yield' makes it a generator, which the framework does not run")
        is_plain = inspect.isfunction(inspect.getattr_static(component, name))
        try:
            inspect.signature(method).bind(*(component,) if is_plain else ())
        except TypeError as error:
            raise DeclarationError(f"{where}.{name}: {error}; {right}") from error
        except ValueError:  # written in another language
            continue


def _hints(kind: type, where: str) -> dict[str, Any]:
    try:
        return typing.get_type_hints(kind)
    except (NameError, TypeError, AttributeError, SyntaxError) as error:
        raise DeclarationError(f"{where}: an annotation cannot be read: {error}") from error


def _inside(aspect: type[Aspect], attribute: str) -> tuple[list[Port], dict[str, str]]:
    """Returns the ports and aspects that a provided aspect adds to the component that declares it."""
    where = f"{aspect.__module__}.{aspect.__qualname__}"
    ports, aspects = [], {}
    for own, annotation in _hints(aspect, where).items():
        default, dotted = getattr(aspect, own, None), f"{attribute}.{own}"
        port = port_of(where, own, annotation, default)
        if port and (port.kind == "reads" or (port.kind == "image" and not port.each)):
            ports.append(replace(port, attribute=dotted))
        elif annotation in (Clock, Logger):
            aspects[dotted] = _ASPECTS[annotation]
        elif port or (not own.startswith("_") and get_origin(annotation) is not ClassVar and default is None):
            raise DeclarationError(
                f"{where}.{own}: an aspect that a component provides has Reads, Each[Reads[...]], Image, Clock and "
                f"Logger, not {_name(annotation)}; what a component writes is declared in its own class"
            )
    return ports, aspects


def _name(annotation: Any) -> str:
    """Returns the name of an annotation as a class writes it, without its types."""
    if get_origin(annotation) is Each:
        return f"Each[{', '.join(map(_name, get_args(annotation)))}]"
    return str(getattr(annotation, "__name__", annotation))


def _provided(component: type[Component], where: str, ports: list[Port]) -> tuple[type[Aspect], ...]:
    """Returns the aspects that a class provides, after checking that it writes what they read."""
    provided = component.provides if isinstance(component.provides, tuple) else (component.provides,)
    written = {port.attribute: port for port in ports if port.writes and not port.each}
    for aspect in provided:
        if not (isinstance(aspect, type) and issubclass(aspect, Aspect)):
            raise DeclarationError(f"{where}: it provides {aspect!r}, not an aspect; derive it from fwk.Aspect")
        for port in _inside(aspect, "")[0]:
            own = port.attribute[1:]
            if not port.each and (own not in written or written[own].message_type is not port.message_type):
                right = "VisionMaster" if port.images else f"Writes[{port.message_type.__name__}]"
                raise DeclarationError(
                    f"{where}: it provides {aspect.__name__}, which reads its channel '{own}'; add {own}: {right}"
                )
    return provided


def _check_every(component: type[Component], where: str, aspects: dict[str, str]) -> None:
    for name, value, least in (("every", component.every, 1), ("offset", component.offset, 0)):
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= EVERY_MAX:
            right = f"it should be a whole number from {least} to {EVERY_MAX}"
            raise DeclarationError(f"{where}: {name} is {value!r}; {right}")
    if component.every > 1 and component.rate_hz is not None:
        raise DeclarationError(f"{where}: both 'every' and 'rate_hz'; keep one")
    if component.every > 1 and "time_source" in aspects.values():
        raise DeclarationError(f"{where}: a time source iterates in each tick; leave 'every' out")


def _check_continuous(where: str, rate_hz: Any, ports: list[Port], aspects: dict[str, str]) -> None:
    if isinstance(rate_hz, bool) or not isinstance(rate_hz, int | float) or not 0 <= rate_hz <= RATE_MAX_HZ:
        raise DeclarationError(f"{where}: rate_hz is {rate_hz!r}; it should be a number from 0 to {RATE_MAX_HZ}")
    for port in ports:
        if port.images:
            raise DeclarationError(
                f"{where}.{port.attribute}: a continuous component cannot use frames, because their ring does not wait "
                "for it; give it a stage, or let a component with a stage read the frames"
            )
    for attribute, aspect in aspects.items():
        if aspect == "time_source":
            raise DeclarationError(
                f"{where}.{attribute}: a continuous component cannot be a time source; give it a stage"
            )
