"""Channel table: dynamic channels, their readers and writers, and the facts that change them at boundaries."""

import json
from bisect import insort
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from fnmatch import fnmatchcase
from typing import Any, Literal, cast

from fwk.lcm import envelope, messages
from fwk.model.plan import NOBODY, Plan
from lcmtypes.core import channel_fact_t, channels_change_t

FactKind = Literal["read", "write", "close", "refuse", "come", "go"]
EventKind = Literal[
    "instance_created", "instance_destroyed", "writer_added", "writer_removed", "reader_added", "reader_removed"
]


@dataclass(frozen=True)
class BlackboardEvent:
    """An event on the blackboard at a boundary."""

    kind: EventKind
    channel: str
    type_name: str
    component: str
    """Component that joined or left; of a created channel its first user, of a destroyed one its last."""


@dataclass(frozen=True)
class Opening:
    """An open dynamic channel; `handle` is the number that the component gave its request."""

    component: int
    handle: int
    channel: int
    name: str
    type_name: str
    fingerprint: str
    sequence: int = 0
    """For a writer: sequence number of the newest message."""

    @property
    def begins(self) -> bytes:
        """First eight bytes of its messages inside a run."""
        return envelope.fingerprint(messages.type_named(self.type_name))


@dataclass(frozen=True)
class Fact:
    """A decision or observation of the supervisor; facts are applied in their order.

    read, write: a component has a channel open. close: it no longer has. refuse: its request is refused. come, go: a
    component begins or ceases to take part in the run; all channels that it has open are closed when it leaves.
    """

    kind: FactKind
    component: int
    handle: int = 0
    opening: Opening | None = None
    reason: str = ""

    def numbered(self, sequence: int) -> "Fact":
        """Returns the fact with the sequence number of the channel's newest message."""
        return replace(self, opening=replace(self.opening, sequence=sequence)) if self.opening else self

    def plain(self) -> list[Any]:
        """Returns plain data for JSON."""
        made: list[Any] = [self.kind, self.component, self.handle]
        if self.opening:
            each = self.opening
            return [*made, each.channel, each.name, each.type_name, each.fingerprint, each.sequence]
        return [*made, self.reason] if self.reason else made

    @classmethod
    def of(cls, data: Sequence[Any]) -> "Fact":
        """Returns the fact of plain data from `plain`."""
        kind, component, handle, *rest = data
        if kind in ("read", "write", "close"):
            return cls(kind, component, handle, Opening(component, handle, *rest))
        return cls(kind, component, handle, reason=rest[0] if rest else "")


@dataclass(frozen=True)
class InstanceView:
    """A channel as it is in a tick."""

    name: str
    type_name: str
    writer: str
    """Full name of the component that writes it; empty if there is none."""
    readers: tuple[str, ...]
    """Full names of the components that read it, in alphabetical order."""
    declared: bool
    """Whether the plan has it; a dynamic channel exists while a component has it open."""


@dataclass
class Instance:
    """A channel in the table."""

    index: int
    name: str
    type_name: str
    declared_writer: int = NOBODY
    declared_readers: tuple[int, ...] = ()
    declared: bool = True
    """Whether the plan has it; a dynamic channel exists while a component has it open."""
    fingerprint: str = ""
    """Fingerprint of a dynamic channel's type."""
    writer: tuple[int, int] | None = None
    """Component and handle of the writer of a dynamic channel."""
    readers: list[tuple[int, int]] = field(default_factory=list)
    """Component and handle of each dynamic reader, in order."""


class ChannelTable:
    """All channels of a run. Equal facts in equal order make equal tables in every process."""

    def __init__(self, plan: Plan) -> None:
        self.names = [component.name for component in plan.components]
        self.present: set[int] = set()
        """Components that take part in the run."""
        self._by_name = {
            channel.name: Instance(channel.index, channel.name, channel.type_name, channel.writer, channel.readers)
            for channel in plan.channels
        }
        self._indices: dict[tuple[str, str], int] = {}  # name and fingerprint of all dynamic channels so far
        self._declared = len(self._by_name)

    def find(self, name: str) -> Instance | None:
        """Returns the channel of a name; None if there is none."""
        return self._by_name.get(name)

    def matching(self, pattern: str) -> list[Instance]:
        """Returns the channels whose names match, ordered by name."""
        return [self._by_name[name] for name in sorted(self._by_name) if fnmatchcase(name, pattern)]

    def writer(self, instance: Instance) -> str:
        """Returns the full name of the component that writes a channel now; empty if there is none."""
        index = instance.writer[0] if instance.writer else instance.declared_writer
        return self.names[index] if index in self.present else ""

    def readers(self, instance: Instance) -> tuple[str, ...]:
        """Returns the full names of the components that read a channel now, in alphabetical order."""
        indices = {*instance.declared_readers, *(component for component, _ in instance.readers)} & self.present
        return tuple(sorted(self.names[index] for index in indices))

    def view(self, instance: Instance) -> InstanceView:
        """Returns the channel as components see it."""
        writer, readers = self.writer(instance), self.readers(instance)
        return InstanceView(instance.name, instance.type_name, writer, readers, instance.declared)

    def index_of(self, name: str, fingerprint: str) -> int | None:
        """Returns the index of a present or former channel; one that is opened again with its type keeps it."""
        instance = self._by_name.get(name)
        return instance.index if instance else self._indices.get((name, fingerprint))

    @property
    def known(self) -> int:
        """Number of indices in use."""
        return self._declared + len(self._indices)

    def opened_by(self, component: int) -> list[Fact]:
        """Returns facts that close every channel that a component has open."""
        found = []
        for instance in self._by_name.values():
            opened = [*([instance.writer] if instance.writer else []), *instance.readers]
            found += [(handle, instance) for owner, handle in opened if owner == component]
        found.sort(key=lambda pair: (pair[0], pair[1].name))
        return [Fact("close", component, handle, _opening(component, handle, instance)) for handle, instance in found]

    def snapshot(self) -> list[Fact]:
        """Returns facts that rebuild this table from an empty one."""
        made = [Fact("come", component) for component in sorted(self.present)]
        for name in sorted(self._by_name):
            instance = self._by_name[name]
            if instance.writer:
                made.append(Fact("write", *instance.writer, _opening(*instance.writer, instance)))
            made += [Fact("read", *reader, _opening(*reader, instance)) for reader in instance.readers]
        return made

    def apply(self, facts: Iterable[Fact]) -> list[BlackboardEvent]:
        """Applies facts; returns the events that follow from them."""
        events: list[BlackboardEvent] = []
        for fact in facts:
            if fact.kind == "come":
                self.present.add(fact.component)
                events += self._presence(fact.component, "added")
            elif fact.kind == "go":
                for closed in self.opened_by(fact.component):
                    events += self._close(closed)
                events += self._presence(fact.component, "removed")
                self.present.discard(fact.component)
            elif fact.kind == "close":
                events += self._close(fact)
            elif fact.kind != "refuse":
                events += self._open(fact)
        return events

    def _open(self, fact: Fact) -> list[BlackboardEvent]:
        opening = fact.opening
        assert opening
        events, instance = [], self._by_name.get(opening.name)
        if instance is None:
            instance = Instance(
                opening.channel, opening.name, opening.type_name, declared=False, fingerprint=opening.fingerprint
            )
            self._by_name[opening.name] = instance
            self._indices[opening.name, opening.fingerprint] = opening.channel
            events.append(self._event("instance_created", instance, fact.component))
        if fact.kind == "write":
            instance.writer = (fact.component, fact.handle)
            events.append(self._event("writer_added", instance, fact.component))
            return events
        before = self.readers(instance)
        insort(instance.readers, (fact.component, fact.handle))
        if self.readers(instance) != before:
            events.append(self._event("reader_added", instance, fact.component))
        return events

    def _close(self, fact: Fact) -> list[BlackboardEvent]:
        assert fact.opening
        instance, key = self._by_name.get(fact.opening.name), (fact.component, fact.handle)
        if instance is None:
            return []
        events = []
        if instance.writer == key:
            instance.writer = None
            events.append(self._event("writer_removed", instance, fact.component))
        elif key in instance.readers:
            before = self.readers(instance)
            instance.readers.remove(key)
            if self.readers(instance) != before:
                events.append(self._event("reader_removed", instance, fact.component))
        if not (instance.declared or instance.writer or instance.readers):
            del self._by_name[instance.name]
            events.append(self._event("instance_destroyed", instance, fact.component))
        return events

    def _presence(self, component: int, how: Literal["added", "removed"]) -> list[BlackboardEvent]:
        """Returns the events of a component that joins or leaves, for the channels that it declares."""
        events = []
        for instance in self._by_name.values():
            if instance.declared_writer == component:
                events.append(self._event("writer_added" if how == "added" else "writer_removed", instance, component))
            if component in instance.declared_readers:
                events.append(self._event("reader_added" if how == "added" else "reader_removed", instance, component))
        return events

    def _event(self, kind: EventKind, instance: Instance, component: int) -> BlackboardEvent:
        return BlackboardEvent(kind, instance.name, instance.type_name, self.names[component])


def _opening(component: int, handle: int, instance: Instance) -> Opening:
    return Opening(component, handle, instance.index, instance.name, instance.type_name, instance.fingerprint)


def facts_of(text: str) -> list[Fact]:
    """Returns the facts of the text that a starting host gets.

    Raises:
        ValueError, TypeError, LookupError: the text does not hold facts.
    """
    return [Fact.of(each) for each in json.loads(text)]


def text_of(facts: Iterable[Fact]) -> str:
    """Returns the text of facts that a starting host gets."""
    return json.dumps([fact.plain() for fact in facts], separators=(",", ":"))


_KINDS: dict[str, int] = {
    "read": channel_fact_t.READ,
    "write": channel_fact_t.WRITE,
    "close": channel_fact_t.CLOSE,
    "refuse": channel_fact_t.REFUSE,
    "come": channel_fact_t.COME,
    "go": channel_fact_t.GO,
}
_KIND_NAMES = {number: name for name, number in _KINDS.items()}


def change_message(number: int, facts: Iterable[Fact]) -> channels_change_t:
    """Returns the facts of one boundary as they are sent and recorded."""
    made = channels_change_t()
    made.number, made.facts = number, [_fact_message(fact) for fact in facts]
    made.n = len(made.facts)
    return made


def facts_in(change: channels_change_t) -> list[Fact]:
    """Returns the facts of a change.

    Raises:
        ValueError: a fact is of an unknown kind.
    """
    return [_fact_in(message) for message in change.facts]


def fingerprint_number(text: str) -> int:
    """Returns the fingerprint of a type, given as 16 hexadecimal digits, as a signed number."""
    return int.from_bytes(bytes.fromhex(text), "big", signed=True)


def fingerprint_text(number: int) -> str:
    """Returns a fingerprint as 16 hexadecimal digits."""
    return number.to_bytes(8, "big", signed=True).hex()


def _fact_message(fact: Fact) -> channel_fact_t:
    made = channel_fact_t()
    made.kind, made.component, made.handle, made.channel = _KINDS[fact.kind], fact.component, fact.handle, -1
    made.reason = fact.reason
    if opening := fact.opening:
        made.channel, made.name, made.type_name = opening.channel, opening.name, opening.type_name
        made.sequence = opening.sequence
        made.fingerprint = fingerprint_number(opening.fingerprint) if opening.fingerprint else 0
    return made


def _fact_in(message: channel_fact_t) -> Fact:
    kind = _KIND_NAMES.get(message.kind)
    if kind is None:
        raise ValueError(f"channel fact of the unknown kind {message.kind}")
    opening = None
    if kind in ("read", "write", "close"):
        fingerprint = fingerprint_text(message.fingerprint) if message.fingerprint else ""
        opening = Opening(
            message.component,
            message.handle,
            message.channel,
            message.name,
            message.type_name,
            fingerprint,
            message.sequence,
        )
    return Fact(cast(FactKind, kind), message.component, message.handle, opening, message.reason)
