"""The channels that a component's class wants: one port for each annotated line."""

from dataclasses import dataclass, replace
from typing import Any, Literal

from fwk.component.channels import ChannelDefault, Reads, ReadsEach, Writes, WritesEach
from fwk.component.commands import Commands
from fwk.component.images import Image, ImagesEach, VisionMaster
from fwk.component.requests import Calls, CallsEach, Serves
from fwk.component.sending import Sends, SendsEach
from fwk.component.services_each import CommandsEach, ServesEach
from fwk.lcm import envelope, messages
from lcmtypes.core import acknowledgement_t


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
    "lines",
    "commands",
    "serves",
    "sends",
    "calls",
    "sends_each",
    "calls_each",
    "commands_each",
    "serves_each",
]
PORT_KINDS: dict[Any, PortKind] = {
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
    CommandsEach: "commands_each",
    ServesEach: "serves_each",
}
IMAGE_KINDS: dict[Any, PortKind] = {Image: "image", ImagesEach: "images_each", VisionMaster: "vision_master"}


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
        return self.kind.endswith("_each")

    @property
    def owns(self) -> bool:
        """Whether the component carries out the commands or answers the requests."""
        return self.kind in ("commands", "serves", "commands_each", "serves_each")

    @property
    def sends(self) -> bool:
        """Whether the component sends commands or requests."""
        return self.kind in ("sends", "calls", "sends_each", "calls_each")

    @property
    def images(self) -> bool:
        """Whether frames lie in a shared-memory ring beside the channel."""
        return self.kind in ("image", "images_each", "vision_master")


def declared_port(where: str, attribute: str, kind: PortKind, types: tuple[Any, ...], default: Any) -> Port:
    """The port of an annotated line; `default` is what the class sets the attribute to.

    Raises:
        DeclarationError: these types do not suit that kind of port.
    """
    for message_type in types:
        if not hasattr(message_type, "_get_packed_fingerprint"):
            raise DeclarationError(f"{where}.{attribute}: {message_type!r} is no LCM type; import it from lcmtypes")
        if mistake := envelope.mistake_in(message_type):
            raise DeclarationError(f"{where}.{attribute}: {mistake}")
    given = ChannelDefault("") if default is None else default
    if not isinstance(given, ChannelDefault) or not isinstance(given.name, str):
        said = f"channel({given.name!r})" if isinstance(given, ChannelDefault) else repr(given)
        raise DeclarationError(
            f"{where}.{attribute}: {said} names no channel; write = channel('cyan1/ball'), or nothing for '{attribute}'"
        )
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
    if not messages.has_header(message_type):
        name = messages.type_name(message_type)
        raise DeclarationError(
            f"{where}.{attribute}: {name} is no {what}: it does not begin with 'core.header_t header;'; types of "
            "devices go with Reads, ReadsEach, Writes and WritesEach"
        )
    if not messages.has_second(message_type, member, f"core.{member}_t"):
        name = messages.type_name(message_type)
        raise DeclarationError(
            f"{where}.{attribute}: {name} is no {what}: its second member is not 'core.{member}_t {member};'"
        )
