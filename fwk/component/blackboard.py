"""The blackboard aspect: channels that a component opens and closes during the run."""

from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from typing import Any, Literal, TypeVar, cast

from fwk.component.channels import Reads, ReadsHistory, Stamp, Writes, WritesPlain
from fwk.component.each import Each
from fwk.lcm import envelope, messages
from fwk.model.channel_table import BlackboardEvent, ChannelState, ChannelTable, ChannelView, Fact
from fwk.model.names import mistake_in

T = TypeVar("T")

REQUESTS_MAX = 64
"""Channels that a component may open and close in one iteration; more are refused as a mistake."""


class NotOpenError(Exception):
    """A channel is written that is not open; the text names the channel and the reason."""


class OpenReads(ReadsHistory[T]):
    """Reader of a dynamic channel; it has no value before it `is_open`, and keeps its value when closed."""

    is_open = False
    refused = ""
    """Reason for which the channel was not opened; empty if it was, and while the request is not decided."""

    def __init__(self, channel: str, message_type: type[T], length: int = 0) -> None:
        super().__init__(channel, message_type, max(1, length))


class OpenWrites(Writes[T]):
    """Writer of a dynamic channel."""

    is_open = False
    refused = ""
    """Reason for which the channel was not opened; empty if it was, and while the request is not decided."""

    def write(self) -> None:
        """Stamps and encodes `value` as it is now; the message is sent at the end of the iteration.

        Raises:
            NotOpenError: the channel is not open yet, or no longer.
            MessageError: a field holds a value that its type cannot.
        """
        if not self.is_open:
            raise NotOpenError(self.refused or f"{self.channel} is not open for writing; check 'is_open' first")
        super().write()


class OpenWritesPlain(OpenWrites[T], WritesPlain[T]):
    """Writer of a dynamic channel whose type has no header."""


class OpenReadsEach(Each[Reads[T]]):
    """Readers of all channels that match a pattern, by channel name; they come and go with the channels."""

    def __init__(self, pattern: str, message_type: type[T], length: int = 0) -> None:
        super().__init__({})
        self.pattern = pattern
        self.message_type = message_type
        self._length = length

    def _put(self, reader: Reads[T]) -> None:
        self._ports = dict(sorted({**self._ports, reader.channel: reader}.items()))

    def _remove(self, channel: str) -> None:
        self._ports.pop(channel, None)


Handle = OpenReads[Any] | OpenWrites[Any] | OpenReadsEach[Any]


class Blackboard:
    """Opens channels that the class does not declare, and lists channels, their writers and readers.

    Requests of an iteration, or of `init`, take effect at the next boundary, in one order for all components, and are
    recorded. Names without a slash belong to the component's namespace, `/JOYSTICK` to none.
    """

    def __init__(
        self, name: str, stamp: Stamp, readers: dict[str, Reads[Any]], writers: dict[str, Writes[Any]]
    ) -> None:
        self.events: tuple[BlackboardEvent, ...] = ()
        """Events since the last iteration, in order; empty in the first iteration."""
        self._name = name
        self._stamp = stamp
        self._readers = readers
        self._writers = writers
        self._declared = frozenset({*readers, *writers})
        self._table: ChannelTable | None = None
        self._handles: dict[int, Handle] = {}
        self._numbers: dict[int, int] = {}  # id of a handle that is open or requested, to its number
        self._newest = 0
        self._reading: dict[str, OpenReads[Any]] = {}
        self._writing: dict[str, OpenWrites[Any]] = {}
        self._holders: dict[str, set[int]] = {}  # channel to the numbers of the handles that share its reader
        self._requests: list[list[Any]] = []
        self._closing: list[OpenWrites[Any]] = []
        self._arrived: list[BlackboardEvent] = []
        self._begun = False

    def open_for_reading(self, message_type: type[T], channel: str, *, history: int = 0) -> Reads[T]:
        """Opens a channel for reading; it may be a channel of the plan, or one that a component opens now or later.

        If the class declares a reader of the channel, that reader is returned. The first iteration with the open
        channel sees its newest value; from then on the newest `history` messages are kept.

        Raises:
            ValueError: the name, type or history is invalid, or this iteration made too many requests.
        """
        self._check(message_type, history)
        full = self._full(channel)
        if full in self._declared and full in self._readers:
            return cast(Reads[T], self._readers[full])
        reader = self._reading.get(full)
        if reader is None or reader.message_type is not message_type:
            reader = OpenReads(full, message_type)
        reader._keep(history)
        if id(reader) not in self._numbers:
            self._open("read", reader, full, message_type)
            self._reading[full] = reader
        return reader

    def open_for_writing(self, message_type: type[T], channel: str) -> OpenWrites[T]:
        """Opens a channel that the plan does not have for writing.

        Raises:
            ValueError: the name or type is invalid, or this iteration made too many requests.
        """
        self._check(message_type)
        full = self._full(channel)
        writer = self._writing.get(full)
        if writer is None or writer.message_type is not message_type or id(writer) not in self._numbers:
            kind = OpenWrites if messages.has_header(cast(Any, message_type)) else OpenWritesPlain
            writer = kind(full, message_type, self._stamp)
            self._open("write", writer, full, message_type)
            self._writing[full] = writer
        return writer

    def open_multiple_for_reading(self, message_type: type[T], pattern: str, *, history: int = 0) -> Each[Reads[T]]:
        """Opens all channels of a type whose names match, `*/ball` or `cyan?/pose`, also those that are opened later.

        Returns:
            Readers by channel name.

        Raises:
            ValueError: the type or history is invalid, or this iteration made too many requests.
        """
        self._check(message_type, history)
        full = self._with_namespace(pattern)
        each = OpenReadsEach(full, message_type, history)
        self._open("each", each, full, message_type)
        return each

    def close(self, handle: Reads[Any] | Writes[Any] | Each[Reads[Any]]) -> None:
        """Closes a dynamic channel: readers at the next tick, a writer at this component's next iteration.

        Raises:
            ValueError: the handle is declared in the class, already closed, or of another component.
        """
        number = self._numbers.pop(id(handle), None)
        if number is None:
            raise ValueError(f"{self._name}: this channel was not opened by this component, or is already closed")
        self._request(["close", number])
        if isinstance(handle, OpenWrites):
            self._closing.append(handle)
        if isinstance(handle, OpenReadsEach) and not handle:
            del self._handles[number]

    def instances(self, pattern: str = "*") -> list[ChannelView]:
        """Returns the channels of this tick whose names match, ordered by name."""
        table = self._table
        return [table.view(state) for state in table.matching(pattern)] if table else []

    def has_writer(self, channel: str) -> bool:
        """Returns whether a component that takes part in the run writes the channel."""
        return self.writer(channel) != ""

    def writer(self, channel: str) -> str:
        """Returns the full name of the component that writes the channel in this tick; empty if there is none."""
        return self._asked_of(channel, lambda table, state: table.writer(state), "")

    def readers(self, channel: str) -> tuple[str, ...]:
        """Returns the full names of the components that read the channel in this tick, ordered."""
        return self._asked_of(channel, lambda table, state: table.readers(state), ())

    def events_of(self, pattern: str) -> list[BlackboardEvent]:
        """Returns those of `events` that concern channels whose names match."""
        return [event for event in self.events if fnmatchcase(event.channel, pattern)]

    def _begin(self) -> None:
        self.events, self._arrived, self._begun = tuple(self._arrived) if self._begun else (), [], True

    def _take(self) -> list[list[Any]]:
        """Ends an iteration; returns its requests."""
        for writer in self._closing:  # the next iteration of a continuous component may begin before this is granted
            self._end_writing(writer)
        taken, self._requests, self._closing = self._requests, [], []
        return taken

    def _take_over(
        self, table: ChannelTable, component: int, fact: Fact, events: Sequence[BlackboardEvent]
    ) -> Literal["opened", "closed", ""]:
        """Applies a decision between two iterations.

        Returns whether the component begins or ceases to read the fact's channel.
        """
        before = len(self._readers)
        self._table = table
        self._arrived += events
        handle = self._handles.get(fact.handle) if fact.component == component else None
        if handle is not None:
            self._settle(fact, handle)
            ended = fact.kind in ("close", "refuse") and self._numbers.get(id(handle)) != fact.handle
            if ended and not (isinstance(handle, OpenReadsEach) and handle):
                del self._handles[fact.handle]
        after = len(self._readers)
        return "opened" if after > before else "closed" if after < before else ""

    def _first(self, table: ChannelTable) -> None:
        """Takes the channel table before the first iteration."""
        self._table = table

    def _settle(self, fact: Fact, handle: Handle) -> None:
        name = fact.channel.name if fact.channel else ""
        if fact.kind == "refuse" and not isinstance(handle, OpenReadsEach):
            handle.refused = fact.reason
            self._numbers.pop(id(handle), None)
            _forget(self._writing if isinstance(handle, OpenWrites) else self._reading, handle)
        elif fact.kind == "write" and isinstance(handle, OpenWrites) and fact.channel:
            if id(handle) in self._numbers:  # not closed in the same iteration
                handle.is_open, handle.sequence = True, fact.channel.sequence
                self._writers[name] = handle
        elif fact.kind == "read" and not isinstance(handle, OpenWrites):
            self._begin_reading(name, fact.handle, handle)
        elif fact.kind == "close" and isinstance(handle, OpenWrites):
            self._end_writing(handle)
        elif fact.kind == "close":
            self._end_reading(name, fact.handle, handle)

    def _begin_reading(self, name: str, number: int, handle: Handle) -> None:
        """Opens a reader for one more handle; all handles of the component share it."""
        reader = self._readers.get(name)
        if reader is None:
            made = self._reading.get(name) if isinstance(handle, OpenReadsEach) else cast(OpenReads[Any], handle)
            reader = made = made or OpenReads(name, handle.message_type)
            made.is_open = True
            self._readers[name] = self._reading[name] = made
        self._holders.setdefault(name, set()).add(number)
        if isinstance(handle, OpenReadsEach):
            if isinstance(reader, OpenReads):
                reader._keep(handle._length)
            handle._put(reader)

    def _end_reading(self, name: str, number: int, handle: Handle) -> None:
        if isinstance(handle, OpenReadsEach):
            handle._remove(name)
        holders = self._holders[name]
        holders.discard(number)
        if not holders and name not in self._declared:
            del self._readers[name]
            self._reading.pop(name).is_open = False

    def _end_writing(self, handle: OpenWrites[Any]) -> None:
        handle.is_open = False
        _forget(self._writers, handle)
        _forget(self._writing, handle)

    def _open(self, what: str, handle: Handle, name: str, message_type: Any) -> None:
        fingerprint = messages.fingerprint(message_type).hex()
        self._newest += 1
        self._request([what, self._newest, name, messages.type_name(message_type), fingerprint])
        self._handles[self._newest], self._numbers[id(handle)] = handle, self._newest

    def _check(self, message_type: Any, history: int = 0) -> None:
        if history < 0:
            raise ValueError(f"{self._name}: history={history}: a history has at least 1 message")
        if not hasattr(message_type, "_get_packed_fingerprint"):
            raise ValueError(f"{self._name}: {message_type!r} is not an LCM type; import it from lcmtypes")
        if mistake := envelope.mistake_in(message_type):
            raise ValueError(f"{self._name}: {mistake}")

    def _request(self, request: list[Any]) -> None:
        if len(self._requests) >= REQUESTS_MAX:
            raise ValueError(f"{self._name}: more than {REQUESTS_MAX} channels opened and closed in one iteration")
        self._requests.append(request)

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

    def _asked_of(self, channel: str, question: Callable[[ChannelTable, ChannelState], T], nothing: T) -> T:
        state = self._table.find(self._full(channel)) if self._table else None
        return question(self._table, state) if self._table and state else nothing


def _forget(table: dict[str, Any], handle: OpenReads[Any] | OpenWrites[Any]) -> None:
    if table.get(handle.channel) is handle:
        del table[handle.channel]
