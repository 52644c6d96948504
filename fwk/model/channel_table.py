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
class OpenChannel:
    """An open dynamic channel; `handle` is the number that the component gave its request."""

    component: int
    handle: int
    index: int
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
    channel: OpenChannel | None = None
    reason: str = ""

    def numbered(self, sequence: int) -> "Fact":
        """Returns the fact with the sequence number of the channel's newest message."""
        return replace(self, channel=replace(self.channel, sequence=sequence)) if self.channel else self

    def plain(self) -> list[Any]:
        """Returns plain data for JSON."""
        made: list[Any] = [self.kind, self.component, self.handle]
        if self.channel:
            each = self.channel
            return [*made, each.index, each.name, each.type_name, each.fingerprint, each.sequence]
        return [*made, self.reason] if self.reason else made

    @classmethod
    def of(cls, data: Sequence[Any]) -> "Fact":
        """Returns the fact of plain data from `plain`."""
        kind, component, handle, *rest = data
        if kind in ("read", "write", "close"):
            return cls(kind, component, handle, OpenChannel(component, handle, *rest))
        return cls(kind, component, handle, reason=rest[0] if rest else "")


@dataclass(frozen=True)
class ChannelView:
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
class ChannelState:
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
            channel.name: ChannelState(channel.index, channel.name, channel.type_name, channel.writer, channel.readers)
            for channel in plan.channels
        }
        self._indices: dict[tuple[str, str], int] = {}  # name and fingerprint of all dynamic channels so far
        self._declared = len(self._by_name)

    def find(self, name: str) -> ChannelState | None:
        """Returns the channel of a name; None if there is none."""
        return self._by_name.get(name)

    def matching(self, pattern: str) -> list[ChannelState]:
        """Returns the channels whose names match, ordered by name."""
        return [self._by_name[name] for name in sorted(self._by_name) if fnmatchcase(name, pattern)]

    def writer(self, state: ChannelState) -> str:
        """Returns the full name of the component that writes a channel now; empty if there is none."""
        index = state.writer[0] if state.writer else state.declared_writer
        return self.names[index] if index in self.present else ""

    def readers(self, state: ChannelState) -> tuple[str, ...]:
        """Returns the full names of the components that read a channel now, in alphabetical order."""
        indices = {*state.declared_readers, *(component for component, _ in state.readers)} & self.present
        return tuple(sorted(self.names[index] for index in indices))

    def view(self, state: ChannelState) -> ChannelView:
        """Returns the channel as components see it."""
        writer, readers = self.writer(state), self.readers(state)
        return ChannelView(state.name, state.type_name, writer, readers, state.declared)

    def index_of(self, name: str, fingerprint: str) -> int | None:
        """Returns the index of a present or former channel; one that is opened again with its type keeps it."""
        state = self._by_name.get(name)
        return state.index if state else self._indices.get((name, fingerprint))

    @property
    def known(self) -> int:
        """Number of indices in use."""
        return self._declared + len(self._indices)

    def opened_by(self, component: int) -> list[Fact]:
        """Returns facts that close every channel that a component has open."""
        found = []
        for state in self._by_name.values():
            opened = [*([state.writer] if state.writer else []), *state.readers]
            found += [(handle, state) for owner, handle in opened if owner == component]
        found.sort(key=lambda pair: (pair[0], pair[1].name))
        return [Fact("close", component, handle, _open_channel(component, handle, state)) for handle, state in found]

    def snapshot(self) -> list[Fact]:
        """Returns facts that rebuild this table from an empty one."""
        made = [Fact("come", component) for component in sorted(self.present)]
        for name in sorted(self._by_name):
            state = self._by_name[name]
            if state.writer:
                made.append(Fact("write", *state.writer, _open_channel(*state.writer, state)))
            made += [Fact("read", *reader, _open_channel(*reader, state)) for reader in state.readers]
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
        opened = fact.channel
        assert opened
        events, state = [], self._by_name.get(opened.name)
        if state is None:
            state = ChannelState(
                opened.index, opened.name, opened.type_name, declared=False, fingerprint=opened.fingerprint
            )
            self._by_name[opened.name] = state
            self._indices[opened.name, opened.fingerprint] = opened.index
            events.append(self._event("instance_created", state, fact.component))
        if fact.kind == "write":
            state.writer = (fact.component, fact.handle)
            events.append(self._event("writer_added", state, fact.component))
            return events
        before = self.readers(state)
        insort(state.readers, (fact.component, fact.handle))
        if self.readers(state) != before:
            events.append(self._event("reader_added", state, fact.component))
        return events

    def _close(self, fact: Fact) -> list[BlackboardEvent]:
        assert fact.channel
        state, key = self._by_name.get(fact.channel.name), (fact.component, fact.handle)
        if state is None:
            return []
        events = []
        if state.writer == key:
            state.writer = None
            events.append(self._event("writer_removed", state, fact.component))
        elif key in state.readers:
            before = self.readers(state)
            state.readers.remove(key)
            if self.readers(state) != before:
                events.append(self._event("reader_removed", state, fact.component))
        if not (state.declared or state.writer or state.readers):
            del self._by_name[state.name]
            events.append(self._event("instance_destroyed", state, fact.component))
        return events

    def _presence(self, component: int, how: Literal["added", "removed"]) -> list[BlackboardEvent]:
        """Returns the events of a component that joins or leaves, for the channels that it declares."""
        events = []
        for state in self._by_name.values():
            if state.declared_writer == component:
                events.append(self._event("writer_added" if how == "added" else "writer_removed", state, component))
            if component in state.declared_readers:
                events.append(self._event("reader_added" if how == "added" else "reader_removed", state, component))
        return events

    def _event(self, kind: EventKind, state: ChannelState, component: int) -> BlackboardEvent:
        return BlackboardEvent(kind, state.name, state.type_name, self.names[component])


def _open_channel(component: int, handle: int, state: ChannelState) -> OpenChannel:
    return OpenChannel(component, handle, state.index, state.name, state.type_name, state.fingerprint)


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
    if opened := fact.channel:
        made.channel, made.name, made.type_name = opened.index, opened.name, opened.type_name
        made.sequence = opened.sequence
        made.fingerprint = fingerprint_number(opened.fingerprint) if opened.fingerprint else 0
    return made


def _fact_in(message: channel_fact_t) -> Fact:
    kind = _KIND_NAMES.get(message.kind)
    if kind is None:
        raise ValueError(f"channel fact of the unknown kind {message.kind}")
    opened = None
    if kind in ("read", "write", "close"):
        fingerprint = fingerprint_text(message.fingerprint) if message.fingerprint else ""
        opened = OpenChannel(
            message.component,
            message.handle,
            message.channel,
            message.name,
            message.type_name,
            fingerprint,
            message.sequence,
        )
    return Fact(cast(FactKind, kind), message.component, message.handle, opened, message.reason)
