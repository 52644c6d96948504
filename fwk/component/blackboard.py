"""The blackboard aspect: channels opened and closed while the run goes on, and who else is there."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from fnmatch import fnmatchcase
from typing import Any, Generic, Literal, TypeVar, cast

from fwk.component.channels import Reads, ReadsHistory, Stamp, Writes, WritesPlain
from fwk.lcm import envelope, messages
from fwk.model.channel_table import BlackboardEvent, ChannelTable, Fact, Instance, InstanceView
from fwk.model.names import mistake_in

T = TypeVar("T")

WISHES_MAX = 64
"""Openings and closings that a component may ask for in an iteration; more is taken for a mistake."""


class NotOpen(Exception):  # noqa: N818 - a state
    """A channel is written that is not open; says which and since when not."""


class OpenReads(ReadsHistory[T]):
    """A reader that was opened at run time; it has nothing before it `is_open`, and keeps its value when closed."""

    is_open = False
    refused = ""
    """Why it was not opened; empty if it was, or nobody has decided yet."""

    def __init__(self, channel: str, message_type: type[T], length: int = 0) -> None:
        super().__init__(channel, message_type, max(1, length))

    def freeze(self, fresh: list[bytes]) -> None:
        """For the framework: begins an iteration. Of what was there before it was opened it sees the newest."""
        super().freeze(fresh if self.has_value else fresh[-1:])


class OpenWrites(Writes[T]):
    """A writer that was opened at run time."""

    is_open = False
    refused = ""
    """Why it was not opened; empty if it was, or nobody has decided yet."""

    def write(self) -> None:
        """Stamps the value as it is now; it goes out at the end of the iteration.

        Raises:
            NotOpen: it is not open yet, or any more.
            MessageError: a field holds something that its type cannot.
        """
        if not self.is_open:
            raise NotOpen(self.refused or f"{self.channel} is not open for writing; ask 'is_open' before")
        super().write()


class OpenWritesPlain(OpenWrites[T], WritesPlain[T]):
    """The same for a type without our header."""


class OpenReadsEach(Mapping[str, Reads[T]], Generic[T]):
    """Readers of every instance that fits a pattern, by channel name; they come and go with the instances."""

    def __init__(self, pattern: str, message_type: type[T], length: int = 0) -> None:
        self.pattern = pattern
        self.message_type = message_type
        self.length = length
        self._readers: dict[str, Reads[T]] = {}

    def __getitem__(self, channel: str) -> Reads[T]:
        return self._readers[channel]

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._readers))

    def __len__(self) -> int:
        return len(self._readers)

    def put(self, reader: Reads[T]) -> None:
        """For the framework: an instance came."""
        self._readers[reader.channel] = reader

    def drop(self, channel: str) -> None:
        """For the framework: an instance went."""
        self._readers.pop(channel, None)


Handle = OpenReads[Any] | OpenWrites[Any] | OpenReadsEach[Any]


class Blackboard:
    """Opens channels that the class does not declare, and tells who has which open.

    What is asked in `init` or an iteration happens between that tick and the next, in one order for all components,
    and is recorded. Names without a slash belong to the component's namespace, `/JOYSTICK` to none.
    """

    def __init__(
        self, name: str, stamp: Stamp, readers: dict[str, Reads[Any]], writers: dict[str, Writes[Any]]
    ) -> None:
        self.events: tuple[BlackboardEvent, ...] = ()
        """What happened on the blackboard since the last iteration, in order; of what was before the first: nothing."""
        self._name = name
        self._stamp = stamp
        self._readers = readers
        self._writers = writers
        self._declared = frozenset({*readers, *writers})
        self._instances: ChannelTable | None = None
        self._handles: dict[int, Handle] = {}
        self._numbers: dict[int, int] = {}  # id of what is open, or was asked for, to its number
        self._newest = 0
        self._reading: dict[str, OpenReads[Any]] = {}
        self._writing: dict[str, OpenWrites[Any]] = {}
        self._holders: dict[str, set[int]] = {}  # of each reader: the handles that want it
        self._wishes: list[list[Any]] = []
        self._closing: list[OpenWrites[Any]] = []
        self._arrived: list[BlackboardEvent] = []
        self._begun = False

    def open_for_reading(self, message_type: type[T], channel: str, *, history: int = 0) -> Reads[T]:
        """A reader of a channel, whether the plan has it or somebody opens it now or later.

        One that the class declares is given as it is. A first iteration with it open has the newest value. It keeps as
        many of the newest messages as `history` says, from then on.

        Raises:
            ValueError: no such name, type or history can be, or too much was asked in this iteration.
        """
        self._check(message_type, history)
        full = self._full(channel)
        if full in self._declared and full in self._readers:
            return cast(Reads[T], self._readers[full])
        reader = self._reading.get(full)
        if reader is None or reader.message_type is not message_type:
            reader = OpenReads(full, message_type)
        reader.keep(history)
        if id(reader) not in self._numbers:
            self._ask("read", reader, full, message_type)
            self._reading[full] = reader
        return reader

    def open_for_writing(self, message_type: type[T], channel: str) -> OpenWrites[T]:
        """The writer of a channel that the plan does not have.

        Raises:
            ValueError: no such name or type can be, or too much was asked in this iteration.
        """
        self._check(message_type)
        full = self._full(channel)
        writer = self._writing.get(full)
        if writer is None or writer.message_type is not message_type or id(writer) not in self._numbers:
            kind = OpenWrites if messages.has_header(cast(Any, message_type)) else OpenWritesPlain
            writer = kind(full, message_type, self._stamp)
            self._ask("write", writer, full, message_type)
            self._writing[full] = writer
        return writer

    def open_multiple_for_reading(self, message_type: type[T], pattern: str, *, history: int = 0) -> OpenReadsEach[T]:
        """Readers of all instances of a type whose names fit: `*/ball`, `cyan?/pose`; those too that come later.

        Raises:
            ValueError: it is no type of a channel, no history, or too much was asked in this iteration.
        """
        self._check(message_type, history)
        full = self._with_namespace(pattern)
        each = OpenReadsEach(full, message_type, history)
        self._ask("each", each, full, message_type)
        return each

    def close(self, handle: Reads[Any] | Writes[Any] | OpenReadsEach[Any]) -> None:
        """From the next tick on it is not open any more; what is written, not from this component's next iteration on.

        Raises:
            ValueError: it is declared in the class, closed already, or of somebody else.
        """
        number = self._numbers.pop(id(handle), None)
        if number is None:
            raise ValueError(f"{self._name}: this was not opened here at run time, or is closed already")
        self._wish(["close", number])
        if isinstance(handle, OpenWrites):
            self._closing.append(handle)
        if isinstance(handle, OpenReadsEach) and not handle:
            del self._handles[number]

    def instances(self, pattern: str = "*") -> list[InstanceView]:
        """The channels that there are in this tick and whose names fit, ordered by name."""
        table = self._instances
        return [table.view(instance) for instance in table.matching(pattern)] if table else []

    def has_writer(self, channel: str) -> bool:
        """Whether somebody who takes part in the run writes the channel."""
        return self.writer(channel) != ""

    def writer(self, channel: str) -> str:
        """Full name of the component that writes the channel in this tick; empty: nobody."""
        return self._asked_of(channel, lambda instances, instance: instances.writer(instance), "")

    def readers(self, channel: str) -> tuple[str, ...]:
        """Full names of the components that read the channel in this tick, ordered."""
        return self._asked_of(channel, lambda instances, instance: instances.readers(instance), ())

    def events_of(self, pattern: str) -> list[BlackboardEvent]:
        """Those of `events` that concern channels whose names fit."""
        return [event for event in self.events if fnmatchcase(event.channel, pattern)]

    def begin(self) -> None:
        """For the framework: an iteration begins."""
        self.events, self._arrived, self._begun = tuple(self._arrived) if self._begun else (), [], True

    def take(self) -> list[list[Any]]:
        """For the framework, at the end of an iteration: what was asked in it."""
        for writer in self._closing:  # the next iteration of a continuous component may begin before this is granted
            self._end_writing(writer)
        taken, self._wishes, self._closing = self._wishes, [], []
        return taken

    def take_over(
        self, instances: ChannelTable, component: int, fact: Fact, events: Sequence[BlackboardEvent]
    ) -> Literal["opened", "closed", ""]:
        """For the framework, between two iterations: what was decided, and what happened by that.

        Says whether the component reads the fact's channel from now on, or does not any more.
        """
        before = len(self._readers)
        self._instances = instances
        self._arrived += events
        handle = self._handles.get(fact.handle) if fact.component == component else None
        if handle is not None:
            self._settle(fact, handle)
            ended = fact.kind in ("close", "refuse") and self._numbers.get(id(handle)) != fact.handle
            if ended and not (isinstance(handle, OpenReadsEach) and handle):
                del self._handles[fact.handle]
        after = len(self._readers)
        return "opened" if after > before else "closed" if after < before else ""

    def first(self, instances: ChannelTable) -> None:
        """For the framework, before the first iteration: the table as it is."""
        self._instances = instances

    def _settle(self, fact: Fact, handle: Handle) -> None:
        name = fact.opening.name if fact.opening else ""
        if fact.kind == "refuse" and not isinstance(handle, OpenReadsEach):
            handle.refused = fact.reason
            self._numbers.pop(id(handle), None)
            _forget(self._writing if isinstance(handle, OpenWrites) else self._reading, handle)
        elif fact.kind == "write" and isinstance(handle, OpenWrites) and fact.opening:
            if id(handle) in self._numbers:  # it has not been closed meanwhile
                handle.is_open, handle.sequence = True, fact.opening.sequence
                self._writers[name] = handle
        elif fact.kind == "read" and not isinstance(handle, OpenWrites):
            self._begin_reading(name, fact.handle, handle)
        elif fact.kind == "close" and isinstance(handle, OpenWrites):
            self._end_writing(handle)
        elif fact.kind == "close":
            self._end_reading(name, fact.handle, handle)

    def _begin_reading(self, name: str, number: int, handle: Handle) -> None:
        """A reader is open for one more handle; whoever wants it in this component has the same one."""
        reader = self._readers.get(name)
        if reader is None:
            made = self._reading.get(name) if isinstance(handle, OpenReadsEach) else cast(OpenReads[Any], handle)
            reader = made = made or OpenReads(name, handle.message_type)
            made.is_open = True
            self._readers[name] = self._reading[name] = made
        self._holders.setdefault(name, set()).add(number)
        if isinstance(handle, OpenReadsEach):
            if isinstance(reader, OpenReads):
                reader.keep(handle.length)
            handle.put(reader)

    def _end_reading(self, name: str, number: int, handle: Handle) -> None:
        if isinstance(handle, OpenReadsEach):
            handle.drop(name)
        holders = self._holders[name]
        holders.discard(number)
        if not holders and name not in self._declared:
            del self._readers[name]
            self._reading.pop(name).is_open = False

    def _end_writing(self, handle: OpenWrites[Any]) -> None:
        handle.is_open = False
        _forget(self._writers, handle)
        _forget(self._writing, handle)

    def _ask(self, what: str, handle: Handle, name: str, message_type: Any) -> None:
        fingerprint = messages.fingerprint(message_type).hex()
        self._newest += 1
        self._wish([what, self._newest, name, messages.type_name(message_type), fingerprint])
        self._handles[self._newest], self._numbers[id(handle)] = handle, self._newest

    def _check(self, message_type: Any, history: int = 0) -> None:
        if history < 0:
            raise ValueError(f"{self._name}: history={history}: a history has at least 1 message")
        if not hasattr(message_type, "_get_packed_fingerprint"):
            raise ValueError(f"{self._name}: {message_type!r} is no LCM type; import it from lcmtypes")
        if mistake := envelope.mistake_in(message_type):
            raise ValueError(f"{self._name}: {mistake}")

    def _wish(self, wish: list[Any]) -> None:
        if len(self._wishes) >= WISHES_MAX:
            raise ValueError(f"{self._name}: more than {WISHES_MAX} openings and closings in one iteration")
        self._wishes.append(wish)

    def _full(self, channel: str) -> str:
        full = self._with_namespace(channel)
        mistake = mistake_in(full)
        if mistake:
            raise ValueError(f"{self._name}: {mistake}")
        return full

    def _with_namespace(self, channel: str) -> str:
        if channel.startswith("/"):
            return channel[1:]
        namespace = self._name.rpartition("/")[0]
        return channel if "/" in channel or not namespace else f"{namespace}/{channel}"

    def _asked_of(self, channel: str, question: Callable[[ChannelTable, Instance], T], nothing: T) -> T:
        instance = self._instances.find(self._full(channel)) if self._instances else None
        return question(self._instances, instance) if self._instances and instance else nothing


def _forget(table: dict[str, Any], handle: OpenReads[Any] | OpenWrites[Any]) -> None:
    if table.get(handle.channel) is handle:
        del table[handle.channel]
