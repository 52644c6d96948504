"""Wires components to channels: expands patterns, finds the one writer of each channel, and reports mistakes."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from fwk.component.port import Port
from fwk.lcm import messages
from fwk.model.errors import hint
from fwk.model.names import LINES, mistake_in, mistake_in_pattern
from fwk.model.plan import NOBODY, ChannelPlan
from fwk.plan.wiring.command_wiring import CommandLines
from fwk.plan.wiring.component_spec import ComponentSpec, Report
from fwk.plan.wiring.providers import Granted, with_providers
from lcmtypes.core import log_t


@dataclass(frozen=True)
class Wiring:
    """The channels of a system, and the channels of each component's ports."""

    channels: tuple[ChannelPlan, ...]
    ports: tuple[dict[str, tuple[str, ...]], ...]
    granted: Granted


def wire(
    specs: Sequence[ComponentSpec],
    report: Report,
    outside: Mapping[str, type[messages.Message]] | None = None,
    may_lack_writer: Callable[[str], bool] = lambda _: False,
) -> Wiring:
    """Wires components. Every mistake goes to `report`; the wiring is then not to be used.

    `outside` are channels that programs outside write, with their types. `may_lack_writer` tells for which channels a
    missing writer is not a mistake; readers of such a channel never see a value.
    """
    specs, granted = with_providers(specs, report, may_lack_writer)
    return _Wiring(specs, granted, report, outside or {}, may_lack_writer).done()


class _Wiring:
    def __init__(
        self,
        specs: Sequence[ComponentSpec],
        granted: Granted,
        report: Report,
        outside: Mapping[str, type[messages.Message]],
        may_lack_writer: Callable[[str], bool],
    ) -> None:
        self._specs = specs
        self._granted = granted
        self._report = report
        self._may_lack_writer = may_lack_writer
        self._writers = {name: (NOBODY, Port(name, "writes", kind, name)) for name, kind in outside.items()}
        if any(port.kind == "lines" for spec in specs for port in spec.declaration.ports):
            self._writers[LINES] = (NOBODY, Port(LINES, "writes", log_t, LINES))
        self._readers: dict[str, list[int]] = {}
        self._ports: list[dict[str, tuple[str, ...]]] = [{} for _ in specs]

    def done(self) -> Wiring:
        asked = [
            (index, spec, port) for index, spec in enumerate(self._specs) for port in spec.declaration.ports
            if self._well_named(spec, port)
        ]  # fmt: skip
        plain = [each for each in asked if not each[2].owns and not each[2].sends]
        read = {spec.pattern(port) for _, spec, port in plain if not port.writes and not port.each}
        for index, spec, port in plain:
            if port.writes:
                self._write(index, spec, port, read)
        written = sorted(self._writers)
        for index, spec, port in plain:
            if not port.writes:
                self._read(index, spec, port, written)
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

    def _well_named(self, spec: ComponentSpec, port: Port) -> bool:
        aspect, _, own = port.attribute.partition(".")
        if own and aspect not in self._granted[self._specs.index(spec)]:  # already reported
            self._ports[self._specs.index(spec)][port.attribute] = ()
            return False
        pattern = spec.pattern(port)
        mistake = (mistake_in_pattern if port.each else mistake_in)(pattern)
        if port.kind == "lines":
            mistake = "" if pattern == LINES else f"it is a target of the log; take '{pattern}' out of its channels"
        if mistake:
            self._report(spec.name, port.attribute, f"port '{port.attribute}': {mistake}")
            self._ports[self._specs.index(spec)][port.attribute] = ()
        return not mistake

    def _write(self, index: int, spec: ComponentSpec, port: Port, read: set[str]) -> None:
        pattern = spec.pattern(port)
        names = tuple(sorted(name for name in read if fnmatchcase(name, pattern))) if port.each else (pattern,)
        self._ports[index][port.attribute] = names
        for name in names:
            if name in self._writers:
                first = self._writers[name][0]
                other = "programs outside" if first == NOBODY else self._specs[first].name
                self._report(spec.name, port.attribute, f"two writers of '{name}': {other} and {spec.name}; keep one")
            else:
                self._writers[name] = (index, port)

    def _read(self, index: int, spec: ComponentSpec, port: Port, written: Sequence[str]) -> None:
        pattern = spec.pattern(port)
        if port.each:
            names = tuple(name for name in written if fnmatchcase(name, pattern))
        else:
            names = (pattern,)
            if pattern not in self._writers and self._may_lack_writer(pattern):
                self._writers[pattern] = (NOBODY, port)
            elif pattern not in self._writers:
                self._report(spec.name, port.attribute, self._missing(spec, port, pattern))
                names = ()
        self._ports[index][port.attribute] = names
        for name in names:
            self._fits(spec, port, name)
            readers = self._readers.setdefault(name, [])
            if index not in readers:
                readers.append(index)

    def _missing(self, spec: ComponentSpec, port: Port, channel: str) -> str:
        """Returns the message that a channel has no writer, or an image no camera, with another that would fit."""
        alike = [
            name
            for name, (_, each) in self._writers.items()
            if messages.is_same_type(each.message_type, port.message_type) and (each.images or not port.images)
        ]
        if port.images:
            right = hint(channel, alike, "add a camera that writes it, or name another channel")
            return f"'{channel}' has no vision master, and {spec.name} looks at it as '{port.attribute}'; {right}"
        right = self._idle_writers(port) or hint(
            channel, alike, "add a component that writes it, or name another channel"
        )
        return f"no component writes '{channel}', which {spec.name} reads as '{port.attribute}'; {right}"

    def _idle_writers(self, port: Port) -> str:
        """Names the components that write such messages to each channel of a pattern, and have none."""
        idle = [
            f"{spec.name} writes '{spec.pattern(each)}', which matches no channel"
            for index, spec in enumerate(self._specs)
            for each in spec.declaration.ports
            if each.each and each.writes and not self._ports[index].get(each.attribute)
            if messages.is_same_type(each.message_type, port.message_type)
        ]
        return ", and ".join(idle)

    def _fits(self, spec: ComponentSpec, port: Port, name: str) -> None:
        index, written = self._writers[name]
        writer = "programs outside" if index == NOBODY else self._specs[index].name
        if not messages.is_same_type(written.message_type, port.message_type):
            self._report(
                spec.name,
                port.attribute,
                f"'{name}' is written by {writer} as {messages.type_name(written.message_type)} "
                f"and read by {spec.name} as {messages.type_name(port.message_type)}; use one type",
            )
        elif port.images and not written.images:
            text = f"'{name}' is not a camera: {writer} is not its vision master; read a channel that is an Image"
            self._report(spec.name, port.attribute, text)
