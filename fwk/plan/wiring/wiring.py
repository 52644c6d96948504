"""Wires components to channels: expands patterns, finds each channel's one writer, and says what does not fit."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from fwk.component.port import Port
from fwk.lcm import messages
from fwk.model.errors import hint
from fwk.model.names import LINES, mistake_in, mistake_in_pattern
from fwk.model.plan import NOBODY, ChannelPlan
from fwk.plan.wiring.command_wiring import CommandLines
from fwk.plan.wiring.component_spec import Report, Wish
from fwk.plan.wiring.providers import Granted, with_providers
from lcmtypes.core import log_t


@dataclass(frozen=True)
class Wiring:
    """The channels, and for each component which channels each of its ports stands for."""

    channels: tuple[ChannelPlan, ...]
    ports: tuple[dict[str, tuple[str, ...]], ...]
    granted: Granted


def wire(
    wishes: Sequence[Wish],
    report: Report,
    outside: Mapping[str, type[messages.Message]] | None = None,
    may_lack_writer: Callable[[str], bool] = lambda _: False,
) -> Wiring:
    """Wires components; every mistake goes to `report`, and the wiring is then not to be used.

    `outside` are channels that other programs write, with their types. `may_lack_writer` says for which channels it is
    no mistake that nobody writes them; a reader of such a channel never sees a value.
    """
    wishes, granted = with_providers(wishes, report, may_lack_writer)
    return _Wiring(wishes, granted, report, outside or {}, may_lack_writer).done()


class _Wiring:
    def __init__(
        self,
        wishes: Sequence[Wish],
        granted: Granted,
        report: Report,
        outside: Mapping[str, type[messages.Message]],
        may_lack_writer: Callable[[str], bool],
    ) -> None:
        self._wishes = wishes
        self._granted = granted
        self._report = report
        self._may_lack_writer = may_lack_writer
        self._writers = {name: (NOBODY, Port(name, "writes", kind, name)) for name, kind in outside.items()}
        if any(port.kind == "lines" for wish in wishes for port in wish.declaration.ports):
            self._writers[LINES] = (NOBODY, Port(LINES, "writes", log_t, LINES))
        self._readers: dict[str, list[int]] = {}
        self._ports: list[dict[str, tuple[str, ...]]] = [{} for _ in wishes]

    def done(self) -> Wiring:
        asked = [
            (index, wish, port) for index, wish in enumerate(self._wishes) for port in wish.declaration.ports
            if self._well_named(wish, port)
        ]  # fmt: skip
        plain = [each for each in asked if not each[2].owns and not each[2].sends]
        read = {wish.pattern(port) for _, wish, port in plain if not port.writes and not port.each}
        for index, wish, port in plain:
            if port.writes:
                self._write(index, wish, port, read)
        written = sorted(self._writers)
        for index, wish, port in plain:
            if not port.writes:
                self._read(index, wish, port, written)
        self._add_commands(CommandLines(asked, self._report, self._may_lack_writer))
        channels = tuple(
            ChannelPlan(
                number,
                name,
                messages.type_name(port.message_type),
                writer,
                tuple(self._readers.get(name, ())),
                port.images,
            )
            for number, (name, (writer, port)) in enumerate(sorted(self._writers.items()))
        )
        return Wiring(channels, tuple(self._ports), self._granted)

    def _add_commands(self, commands: CommandLines) -> None:
        for line in commands.lines.values():
            self._writers[line.name] = (line.writer, Port(line.name, "writes", line.message_type, line.name))
            self._readers[line.name] = list(line.readers)
        for (index, attribute), names in commands.ports.items():
            self._ports[index][attribute] = names

    def _well_named(self, wish: Wish, port: Port) -> bool:
        aspect, _, own = port.attribute.partition(".")
        if own and aspect not in self._granted[self._wishes.index(wish)]:  # told already
            self._ports[self._wishes.index(wish)][port.attribute] = ()
            return False
        pattern = wish.pattern(port)
        mistake = (mistake_in_pattern if port.each else mistake_in)(pattern)
        if port.kind == "lines":
            mistake = "" if pattern == LINES else f"it is a target of the log; take '{pattern}' out of its channels"
        if mistake:
            self._report(wish.name, port.attribute, f"port '{port.attribute}': {mistake}")
            self._ports[self._wishes.index(wish)][port.attribute] = ()
        return not mistake

    def _write(self, index: int, wish: Wish, port: Port, read: set[str]) -> None:
        pattern = wish.pattern(port)
        names = tuple(sorted(name for name in read if fnmatchcase(name, pattern))) if port.each else (pattern,)
        self._ports[index][port.attribute] = names
        for name in names:
            if name in self._writers:
                first = self._writers[name][0]
                other = "programs outside" if first == NOBODY else self._wishes[first].name
                self._report(wish.name, port.attribute, f"two writers of '{name}': {other} and {wish.name}; keep one")
            else:
                self._writers[name] = (index, port)

    def _read(self, index: int, wish: Wish, port: Port, written: Sequence[str]) -> None:
        pattern = wish.pattern(port)
        if port.each:
            names = tuple(name for name in written if fnmatchcase(name, pattern))
        else:
            names = (pattern,)
            if pattern not in self._writers and self._may_lack_writer(pattern):
                self._writers[pattern] = (NOBODY, port)
            elif pattern not in self._writers:
                self._report(wish.name, port.attribute, self._missing(wish, port, pattern))
                names = ()
        self._ports[index][port.attribute] = names
        for name in names:
            self._fits(wish, port, name)
            readers = self._readers.setdefault(name, [])
            if index not in readers:
                readers.append(index)

    def _missing(self, wish: Wish, port: Port, channel: str) -> str:
        """That a channel has no writer, or an image no camera, and which other a port could read."""
        alike = [
            name
            for name, (_, each) in self._writers.items()
            if messages.is_same_type(each.message_type, port.message_type) and (each.images or not port.images)
        ]
        if port.images:
            right = hint(channel, alike, "add a camera that writes it, or name another channel")
            return f"'{channel}' has no vision master, and {wish.name} looks at it as '{port.attribute}'; {right}"
        right = hint(channel, alike, "add a component that writes it, or name another channel")
        return f"nobody writes '{channel}', which {wish.name} reads as '{port.attribute}'; {right}"

    def _fits(self, wish: Wish, port: Port, name: str) -> None:
        index, written = self._writers[name]
        writer = "programs outside" if index == NOBODY else self._wishes[index].name
        if not messages.is_same_type(written.message_type, port.message_type):
            self._report(
                wish.name,
                port.attribute,
                f"'{name}' is written by {writer} as {messages.type_name(written.message_type)} "
                f"and read by {wish.name} as {messages.type_name(port.message_type)}; use one type",
            )
        elif port.images and not written.images:
            text = f"'{name}' is not a camera: {writer} is not its vision master; read a channel that is an Image"
            self._report(wish.name, port.attribute, text)
