"""The blackboard aspect: typed channels with one writer and many readers, frozen for the time of an iteration."""

from collections import deque
from collections.abc import Callable, ItemsView, Iterator, Mapping, Sequence
from typing import Any, Generic, TypeVar, cast, overload

from fwk.lcm import envelope, messages
from fwk.lcm.messages import Header
from lcmtypes.core import header_t

T = TypeVar("T")


class Stamp:
    """What the header of everything written in the running iteration says; shared by a component's writers."""

    __slots__ = ("stage", "tick", "time_us", "writer")

    def __init__(self, writer: str) -> None:
        self.writer = writer
        self.tick = 0
        self.stage = 0
        self.time_us = 0


class Reads(Generic[T]):
    """A reader of one channel.

    What it shows stays the same during an iteration, whatever arrives meanwhile.
    Before the first message `value` is the type's zero and `has_value` is false.
    """

    def __init__(self, channel: str, message_type: type[T]) -> None:
        self.channel = channel
        self.message_type = message_type
        self.refreshed = False  # a message came since the last iteration
        self._fresh: list[bytes] = []
        self._raw: bytes | None = None
        self._before: bytes | None = None
        self._value: T | None = None
        self._header: Header | None = None
        self._decode: Callable[[bytes], T] = envelope.decoder(cast(Any, message_type), channel)

    def freeze(self, fresh: list[bytes]) -> None:
        """For the framework: begins an iteration; `fresh` became visible since the last one, oldest first."""
        self._fresh = fresh
        self.refreshed = bool(fresh)
        if fresh:
            self._before = self._raw
            self._raw = fresh[-1]
            self._value = None
            self._header = None

    @property
    def raw(self) -> bytes | None:
        """For the framework: the newest message as it came."""
        return self._raw

    @property
    def has_value(self) -> bool:
        """Whether the channel was ever written."""
        return self._raw is not None

    @property
    def changed(self) -> bool:
        """Whether the value differs from that of the last iteration; its header does not count."""
        if not self.refreshed or self._raw is None:
            return False
        if self._before is None:
            return True
        return self._raw[self.header.end :] != self._before[Header.of(self._before).end :]

    @property
    def value(self) -> T:
        """The newest message. It is this reader's own copy."""
        if self._value is None:
            self._value = self.message_type() if self._raw is None else self._decode(self._raw)
        return self._value

    @property
    def fresh(self) -> list[T]:
        """Every message since the last iteration, oldest first."""
        return [*map(self._decode, self._fresh[:-1]), self.value] if self._fresh else []

    @property
    def history(self) -> Sequence[T]:
        """The newest messages, oldest first: as many as `channel(history=...)` keeps, without it the newest only."""
        return [self.value] if self.has_value else []

    @property
    def header(self) -> Header:
        """Tick, stage, sequence, writer and logical time of the newest message; zeros before the first."""
        if self._header is None:
            self._header = Header(0, 0, 0, 0, "", 0) if self._raw is None else Header.of(self._raw)
        return self._header


class ReadsHistory(Reads[T]):
    """A reader that keeps the newest messages, `length` of them."""

    def __init__(self, channel: str, message_type: type[T], length: int) -> None:
        super().__init__(channel, message_type)
        self._history = History(length, self._decode)

    def freeze(self, fresh: list[bytes]) -> None:
        """For the framework: begins an iteration; `fresh` became visible since the last one, oldest first."""
        super().freeze(fresh)
        self._history.add(fresh)

    @property
    def value(self) -> T:
        """The newest message. It is this reader's own copy, and the last of the history."""
        return self._history[-1] if self._history else super().value

    @property
    def history(self) -> Sequence[T]:
        """The newest messages, oldest first; after a restart it begins anew."""
        return self._history

    def keep(self, length: int) -> None:
        """For the framework: from now on so many at the least."""
        self._history.keep(length)


class History(Sequence[T]):
    """The newest messages of a channel, each decoded when it is looked at first."""

    def __init__(self, length: int, decode: Callable[[bytes], T]) -> None:
        self._decode = decode
        self._raw: deque[bytes] = deque(maxlen=length)
        self._values: deque[T | None] = deque(maxlen=length)

    def keep(self, length: int) -> None:
        """From now on so many at the least."""
        if length > (self._raw.maxlen or 0):
            self._raw, self._values = deque(self._raw, length), deque(self._values, length)

    def add(self, fresh: Sequence[bytes]) -> None:
        """Newer ones push the oldest out."""
        self._raw.extend(fresh)
        self._values.extend([None] * len(fresh))

    def __len__(self) -> int:
        return len(self._raw)

    @overload
    def __getitem__(self, index: int) -> T: ...
    @overload
    def __getitem__(self, index: slice) -> list[T]: ...
    def __getitem__(self, index: int | slice) -> T | list[T]:
        if isinstance(index, slice):
            return [self[place] for place in range(*index.indices(len(self)))]
        value = self._values[index]
        if value is None:
            value = self._values[index] = self._decode(self._raw[index])
        return value


class Writes(Generic[T]):
    """The one writer of a channel: change `value`, then `write()`.

    Everything written in an iteration goes out together at its end; if the iteration fails, nothing does.
    """

    def __init__(self, channel: str, message_type: type[T], stamp: Stamp | None = None) -> None:
        self.channel = channel
        self.message_type = message_type
        self.value: T = message_type()
        self.sequence = 0  # of the newest message that went out
        self._stamp = stamp or Stamp("")
        self._buffer: list[bytes] = []
        self._encode: Callable[[T], bytes] = messages.encoder(cast(Any, message_type), channel)

    def write(self) -> None:
        """Stamps the value as it is now; it goes out at the end of the iteration.

        Raises:
            MessageError: a field holds something that its type cannot.
        """
        stamp = self._stamp
        header: header_t = self.value.header  # type: ignore[attr-defined]  # has one, or would be no interface
        header.tick = stamp.tick
        header.stage = stamp.stage
        header.time_us = stamp.time_us
        header.writer = stamp.writer
        header.sequence = self.sequence + len(self._buffer) + 1
        self._buffer.append(self._encode(self.value))

    @property
    def written(self) -> Sequence[bytes]:
        """For the framework: what was written in this iteration, oldest first."""
        return self._buffer

    @property
    def pending(self) -> int:
        """Messages written in this iteration, not yet sent."""
        return len(self._buffer)

    def take(self) -> list[bytes]:
        """For the framework: ends an iteration; the messages to send, oldest first."""
        taken, self._buffer = self._buffer, []
        self.sequence += len(taken)
        return taken

    def drop(self) -> None:
        """For the framework: the iteration failed; nothing goes out."""
        self._buffer = []


class WritesPlain(Writes[T]):
    """The writer of a channel whose type has no header: the value stays as it is, its envelope is stamped."""

    def write(self) -> None:
        """Stamps the value as it is now; it goes out at the end of the iteration.

        Raises:
            MessageError: a field holds something that its type cannot.
        """
        stamp, sequence = self._stamp, self.sequence + len(self._buffer) + 1
        plain = self._encode(self.value)
        self._buffer.append(envelope.wrapped(plain, stamp.tick, sequence, stamp.time_us, stamp.stage, stamp.writer))


class ReadsEach(Mapping[str, Reads[T]], Generic[T]):
    """Readers of many instances of an interface, by namespace, in alphabetical order.

    `for robot, motor in self.motors.items(): ...`
    """

    def __init__(self, channels: Mapping[str, Reads[T]]) -> None:
        self._channels = dict(sorted(channels.items()))

    def __getitem__(self, key: str) -> Reads[T]:
        return self._channels[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)

    def items(self) -> ItemsView[str, Reads[T]]:
        """Pairs of namespace and reader."""
        return self._channels.items()


class WritesEach(Mapping[str, Writes[T]], Generic[T]):
    """Writers of many instances of an interface, by namespace: one for each that somebody reads."""

    def __init__(self, channels: Mapping[str, Writes[T]]) -> None:
        self._channels = dict(sorted(channels.items()))

    def __getitem__(self, key: str) -> Writes[T]:
        return self._channels[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._channels)

    def __len__(self) -> int:
        return len(self._channels)

    def items(self) -> ItemsView[str, Writes[T]]:
        """Pairs of namespace and writer."""
        return self._channels.items()


def channel(name: str = "", *, history: int = 0) -> Any:
    """Names the channel of a reader or writer in the class, where it is not `<namespace>/<attribute>`.

    A name with a slash is used as it is (`cyan1/odometry`), one without belongs to the component's namespace.
    For `ReadsEach` and `WritesEach` it is a pattern with `*` for the namespace (`*/motor`).
    The launch file can say otherwise. A reader keeps as many of the newest messages as `history` says.
    """
    return ChannelDefault(name, history)


class ChannelDefault:
    """What `channel()` puts into the class until the framework replaces it by the reader or writer."""

    def __init__(self, name: str, history: int = 0) -> None:
        self.name = name
        self.history = history
