"""Wires services: finds the owner of each, and the channels of its requests and answers."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase

from fwk.component.port import Port
from fwk.lcm import messages
from fwk.model.errors import hint
from fwk.model.names import CHANNEL_BYTES
from fwk.model.plan import NOBODY
from fwk.model.service_channels import ANSWERS, OUTSIDE, service_channel
from fwk.plan.wiring.component_spec import ComponentSpec, Report


@dataclass(frozen=True)
class Line:
    """A channel between the clients of a service and the component that offers it, the owner."""

    name: str
    message_type: type[messages.Message]
    writer: int
    readers: tuple[int, ...]


@dataclass(frozen=True)
class _End:
    """A component's port to a service."""

    index: int
    spec: ComponentSpec
    port: Port

    @property
    def name(self) -> str:
        return self.spec.name

    @property
    def types(self) -> tuple[type[messages.Message], type[messages.Message]]:
        assert self.port.reply_type
        return self.port.message_type, self.port.reply_type


class CommandLines:
    """Channels of all services of a system; `ports` are the channels of each component's ports.

    An owner's port has the channel of the answers and those of its clients, one such row for each name that it owns. A
    client's port has its own channel and that of the answers, one pair for each owner.
    """

    def __init__(
        self, asked: Sequence[tuple[int, ComponentSpec, Port]], report: Report, may_lack_owner: Callable[[str], bool]
    ) -> None:
        self.lines: dict[str, Line] = {}
        self.ports: dict[tuple[int, str], tuple[str, ...]] = {}
        self._report = report
        ends = [_End(*each) for each in asked if each[2].owns or each[2].sends]
        owners: dict[str, _End] = {}
        asked_for = sorted({end.spec.pattern(end.port) for end in ends if end.port.sends and not end.port.each})
        for end in ends:
            if end.port.owns:
                pattern = end.spec.pattern(end.port)
                self.ports[end.index, end.port.attribute] = ()
                targets = [name for name in asked_for if fnmatchcase(name, pattern)] if end.port.each else [pattern]
                for target in targets:
                    self._own(end, target, owners)
        senders: dict[str, list[_End]] = {target: [] for target in owners}
        for end in ends:
            if end.port.sends:
                self._send(end, owners, senders, may_lack_owner)
        for target, ends_of in senders.items():
            if ends_of or target in owners:
                self._join(target, owners.get(target), ends_of)

    def _own(self, end: _End, target: str, owners: dict[str, _End]) -> None:
        if target in owners:
            text = f"two components carry out '{target}': {owners[target].name} and {end.name}; keep one"
            self._report(end.name, end.port.attribute, text)
        else:
            owners[target] = end

    def _send(
        self,
        end: _End,
        owners: Mapping[str, _End],
        senders: dict[str, list[_End]],
        may_lack_owner: Callable[[str], bool],
    ) -> None:
        pattern, attribute = end.spec.pattern(end.port), end.port.attribute
        targets = sorted(name for name in owners if fnmatchcase(name, pattern)) if end.port.each else [pattern]
        self.ports[end.index, attribute] = ()
        for target in targets:
            if target not in owners and not may_lack_owner(target):
                right = hint(target, owners, "add a component that does, or name other commands")
                text = f"no component carries out '{target}', which {end.name} sends as '{attribute}'; {right}"
                self._report(end.name, attribute, text)
            elif any(other.index == end.index for other in senders.setdefault(target, [])):
                text = f"{end.name} sends '{target}' by two ports, one of them '{attribute}'; keep one"
                self._report(end.name, attribute, text)
            elif target not in owners or self._fits(end, target, owners[target]):
                senders[target].append(end)

    def _fits(self, sender: _End, target: str, owner: _End) -> bool:
        for sent, taken, what in zip(sender.types, owner.types, ("", "the reply to "), strict=True):
            if not messages.is_same_type(sent, taken):
                text = (
                    f"{what}'{target}' is {messages.type_name(taken)} for {owner.name}, which carries it out, "
                    f"and {messages.type_name(sent)} for {sender.name}, which sends it; use one type"
                )
                self._report(sender.name, sender.port.attribute, text)
                return False
        return True

    def _join(self, target: str, owner: _End | None, senders: Sequence[_End]) -> None:
        command, reply = (owner or senders[0]).types
        answers = service_channel(target, ANSWERS)
        self._add(owner or senders[0], Line(answers, reply, owner.index if owner else NOBODY, _indices(senders)))
        names = []
        if owner:
            names.append(service_channel(target, OUTSIDE))
            self._add(owner, Line(names[-1], command, NOBODY, (owner.index,)))
        for sender in sorted(senders, key=lambda each: each.name):
            names.append(service_channel(target, sender.name))
            self._add(sender, Line(names[-1], command, sender.index, (owner.index,) if owner else ()))
            self.ports[sender.index, sender.port.attribute] += (names[-1], answers)
        if owner:
            self.ports[owner.index, owner.port.attribute] += (answers, *names)

    def _add(self, end: _End, line: Line) -> None:
        if end.name in (ANSWERS, OUTSIDE):
            text = f"a component that is called '{end.name}' cannot send or carry out commands; rename it"
            self._report(end.name, end.port.attribute, text)
        size = len(line.name.encode())
        if size > CHANNEL_BYTES:
            text = f"'{line.name}' would have {size} bytes, LCM carries {CHANNEL_BYTES}; shorten a name"
            self._report(end.name, end.port.attribute, text)
        self.lines[line.name] = line


def _indices(ends: Sequence[_End]) -> tuple[int, ...]:
    return tuple(sorted(end.index for end in ends))
