"""Ports of a component's class: one annotated line for each."""

from dataclasses import dataclass, replace
from typing import Any, Literal, get_args, get_origin

from fwk.component.calls import Calls
from fwk.component.channels import ChannelDefault, Reads, Writes
from fwk.component.each import Each
from fwk.component.images import Image, VisionMaster
from fwk.component.services import Serves
from fwk.lcm import envelope, messages
from lcmtypes.core import acknowledgement_t, frame_t


class DeclarationError(Exception):
    """A component's class declares something invalid; the text names class, attribute and what would be right."""


PortKind = Literal["reads", "writes", "serves", "calls", "image", "vision_master", "lines"]
_TYPED: dict[Any, PortKind] = {Reads: "reads", Writes: "writes", Serves: "serves", Calls: "calls"}
_IMAGES: dict[Any, PortKind] = {Image: "image", VisionMaster: "vision_master"}


@dataclass(frozen=True)
class Port:
    """A port: its attribute, its kind and type, and the name or pattern of its channels in the class.

    A port of a service has a channel for each client's requests and one for the answers, which are of `reply_type`.
    """

    attribute: str
    kind: PortKind
    message_type: type[messages.Message]
    channel: str
    each: bool = False
    """Whether it is an `Each`, with a port for every namespace."""
    reply_type: type[messages.Message] | None = None
    history: int = 0
    """Number of the newest messages that a reader keeps; 0: only the newest."""

    @property
    def writes(self) -> bool:
        """Whether the component writes the channel."""
        return self.kind in ("writes", "vision_master")

    @property
    def owns(self) -> bool:
        """Whether the component offers the service."""
        return self.kind == "serves"

    @property
    def sends(self) -> bool:
        """Whether the component uses the service."""
        return self.kind == "calls"

    @property
    def images(self) -> bool:
        """Whether frames lie in a shared-memory ring beside the channel."""
        return self.kind in ("image", "vision_master")


def port_of(where: str, attribute: str, annotation: Any, default: Any) -> Port | None:
    """Returns the port of an annotated line; None if the annotation is not that of a port.

    Args:
        where: Full name of the class.
        attribute: Name of the attribute.
        annotation: Its type.
        default: Value that the class sets the attribute to, or None.

    Raises:
        DeclarationError: the annotation or the default is not valid for a port.
    """
    each = annotation is Each or get_origin(annotation) is Each
    if each:
        (annotation,) = get_args(annotation) or (None,)
    kind = _TYPED.get(get_origin(annotation)) or _IMAGES.get(annotation)
    types = (frame_t,) if annotation in _IMAGES else get_args(annotation)
    if annotation in _TYPED:
        raise DeclarationError(f"{where}.{attribute}: {_without_type(attribute, annotation, each)}")
    if each and (kind is None or kind == "vision_master"):
        inner = "nothing" if annotation is None else getattr(annotation, "__name__", annotation)
        right = "Each is for Reads, Writes, Serves, Calls and Image, such as Each[Reads[ball_t]]"
        raise DeclarationError(f"{where}.{attribute}: Each of {inner}; {right}")
    return _declared(where, attribute, kind, each, types, default) if kind else None


def _without_type(attribute: str, annotation: Any, each: bool) -> str:
    name = annotation.__name__
    types = ("command_t", "request_t, reply_t") if annotation in (Serves, Calls) else ("message_t",)
    right = " or ".join(f"Each[{name}[{each_type}]]" if each else f"{name}[{each_type}]" for each_type in types)
    return f"{name} has no message type; write {attribute}: {right}"


def _declared(where: str, attribute: str, kind: PortKind, each: bool, types: tuple[Any, ...], default: Any) -> Port:
    for message_type in types:
        if not isinstance(message_type, type) or not hasattr(message_type, "_get_packed_fingerprint"):
            raise DeclarationError(
                f"{where}.{attribute}: {message_type!r} is not an LCM type; import one from lcmtypes"
            )
        if mistake := envelope.mistake_in(message_type):
            raise DeclarationError(f"{where}.{attribute}: {mistake}")
    given = ChannelDefault("") if default is None else default
    if not isinstance(given, ChannelDefault) or not isinstance(given.name, str):
        value = f"channel({given.name!r})" if isinstance(given, ChannelDefault) else repr(given)
        right = f"write = channel('cyan1/ball'), or nothing for '{attribute}'"
        raise DeclarationError(f"{where}.{attribute}: {value} does not name a channel; {right}")
    if given.history < 0 or (given.history and kind != "reads"):
        wrong = "a history has at least 1 message" if given.history < 0 else "only Reads keeps a history"
        raise DeclarationError(f"{where}.{attribute}: history={given.history}: {wrong}")
    made = Port(attribute, kind, types[0], given.name or attribute, each, history=given.history)
    if made.owns or made.sends:
        made = replace(made, reply_type=types[1] if len(types) > 1 else acknowledgement_t)
        _check_second(where, attribute, types[0], "command", "request")
        _check_second(where, attribute, made.reply_type, "answer", "reply")
    if each and "*" not in made.channel:
        made = replace(made, channel=f"*/{made.channel}")
    return made


def _check_second(where: str, attribute: str, message_type: Any, member: str, role: str) -> None:
    wrong = ""
    if not messages.has_header(message_type):
        wrong = (
            "it does not begin with 'core.header_t header;'; types of devices go with Reads, Writes and Each of them"
        )
    elif not messages.has_second(message_type, member, f"core.{member}_t"):
        wrong = f"its second member is not 'core.{member}_t {member};'"
    if wrong:
        raise DeclarationError(f"{where}.{attribute}: {messages.type_name(message_type)} is not a {role}: {wrong}")
