"""Wires components to channels: expands patterns, finds each channel's one writer, and says what does not fit."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from fnmatch import fnmatchcase

from fwk import messages
from fwk.component import Declaration, Port
from fwk.plan.model import ChannelPlan


@dataclass(frozen=True)
class Wish:
    """A component as the launch file asks for it."""

    name: str
    declaration: Declaration
    channels: Mapping[str, str] = field(default_factory=dict)
    """Port attribute to channel or pattern, where the launch file says other than the class."""

    @property
    def namespace(self) -> str:
        """Everything before the last slash of the name."""
        return self.name.rpartition("/")[0]

    def pattern(self, port: Port) -> str:
        """The full channel name or pattern of a port."""
        name = self.channels.get(port.attribute, port.channel)
        return name if "/" in name or not self.namespace else f"{self.namespace}/{name}"


Report = Callable[[str, str | None, str], None]
"""Takes a mistake: component, port attribute or None, text."""


@dataclass(frozen=True)
class Wiring:
    """The channels, and for each component which channels each of its ports stands for."""

    channels: tuple[ChannelPlan, ...]
    ports: tuple[dict[str, tuple[str, ...]], ...]


def wire(wishes: Sequence[Wish], report: Report) -> Wiring:
    """Wires components; every mistake goes to `report`, and the wiring is then not to be used."""
    read = {
        wish.pattern(port) for wish in wishes for port in wish.declaration.ports if not port.writes and not port.each
    }
    writers: dict[str, tuple[int, Port]] = {}
    ports: list[dict[str, tuple[str, ...]]] = [{} for _ in wishes]
    for index, wish in enumerate(wishes):
        for port in wish.declaration.ports:
            if port.writes:
                pattern = wish.pattern(port)
                names = tuple(sorted(name for name in read if fnmatchcase(name, pattern))) if port.each else (pattern,)
                ports[index][port.attribute] = names
                for name in names:
                    if name in writers:
                        other = wishes[writers[name][0]].name
                        report(wish.name, port.attribute, f"two writers of '{name}': {other} and {wish.name}; keep one")
                    else:
                        writers[name] = (index, port)
    readers: dict[str, list[int]] = {name: [] for name in writers}
    for index, wish in enumerate(wishes):
        for port in wish.declaration.ports:
            if not port.writes:
                ports[index][port.attribute] = _readable(wishes, wish, port, writers, report)
                for name in ports[index][port.attribute]:
                    if index not in readers[name]:
                        readers[name].append(index)
    channels = tuple(
        ChannelPlan(number, name, messages.type_name(port.message_type), writer, tuple(readers[name]), port.images)
        for number, (name, (writer, port)) in enumerate(sorted(writers.items()))
    )
    for channel in channels:
        if len(channel.name.encode()) > 63:
            report(wishes[channel.writer].name, None, f"channel name '{channel.name}' is longer than LCM's 63 bytes")
    return Wiring(channels, tuple(ports))


def _readable(
    wishes: Sequence[Wish], wish: Wish, port: Port, writers: Mapping[str, tuple[int, Port]], report: Report
) -> tuple[str, ...]:
    pattern = wish.pattern(port)
    names = sorted(name for name in writers if fnmatchcase(name, pattern)) if port.each else [pattern]
    if not port.each and pattern not in writers:
        near = get_close_matches(pattern, writers, 1)
        hint = f"did you mean '{near[0]}'?" if near else "load a component that writes it, or name another channel"
        report(wish.name, port.attribute, f"nobody writes '{pattern}', which {wish.name} reads; {hint}")
        return ()
    for name in names:
        index, writer = writers[name]
        if messages.fingerprint(writer.message_type) != messages.fingerprint(port.message_type):
            report(
                wish.name,
                port.attribute,
                f"'{name}' is written by {wishes[index].name} as {messages.type_name(writer.message_type)} "
                f"and read by {wish.name} as {messages.type_name(port.message_type)}",
            )
        if port.images and not writer.images:
            report(wish.name, port.attribute, f"'{name}' is no camera: {wishes[index].name} is not its vision master")
    return tuple(names)
