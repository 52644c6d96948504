"""Ports to channels: readers that are frozen during an iteration, and the one writer of a channel."""

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Generic, TypeVar, cast, overload

from fwk.lcm import envelope, messages
from fwk.lcm.messages import Header
from lcmtypes.core import header_t

T = TypeVar("T")


class Stamp:
    """Header fields of everything written in the running iteration; shared by the writers of a component."""

    __slots__ = ("stage", "tick", "time_us", "writer")

    def __init__(self, writer: str) -> None:
        self.writer = writer
        self.tick = 0
        self.stage = 0
        self.time_us = 0


class Reads(Generic[T]):
    """Reader of one channel.

    Its content does not change during an iteration, whatever arrives in the meantime.
    Before the first message `value` is the type's zero and `has_value` is false.
    """

    def __init__(self, channel: str, message_type: type[T]) -> None:
        self.channel = channel
        self.message_type = message_type
        self.refreshed = False
        """Whether a message became visible since the last iteration."""
        self._fresh: list[bytes] = []
        self._raw: bytes | None = None  # newest message, encoded
        self._before: bytes | None = None
        self._value: T | None = None
        self._header: Header | None = None
        self._decode: Callable[[bytes], T] = envelope.decoder(cast(Any, message_type), channel)

    def _freeze(self, fresh: list[bytes]) -> None:
        """Begins an iteration; `fresh` became visible since the last one, oldest first."""
        self._fresh = fresh
        self.refreshed = bool(fresh)
        if fresh:
            self._before = self._raw
            self._raw = fresh[-1]
            self._value = None
            self._header = None

    @property
    def has_value(self) -> bool:
        """Whether a message of the channel was ever visible."""
        return self._raw is not None

    @property
    def changed(self) -> bool:
        """Whether the value differs from that of the last iteration; headers are not compared."""
        if not self.refreshed or self._raw is None:
            return False
        if self._before is None:
            return True
        return self._raw[self.header.end :] != self._before[Header.of(self._before).end :]

    @property
    def value(self) -> T:
        """Newest message; a copy that belongs to this reader."""
        if self._value is None:
            self._value = self.message_type() if self._raw is None else self._decode(self._raw)
        return self._value

    @property
    def fresh(self) -> list[T]:
        """Every message since the last iteration, oldest first."""
        return [*map(self._decode, self._fresh[:-1]), self.value] if self._fresh else []

    @property
    def history(self) -> Sequence[T]:
        """The newest messages, oldest first: as many as `channel(history=...)` keeps, by default only the newest."""
        return [self.value] if self.has_value else []

    @property
    def header(self) -> Header:
        """Tick, stage, sequence number, writer and logical time of the newest message; zeros before the first."""
        if self._header is None:
            self._header = Header(0, 0, 0, 0, "", 0) if self._raw is None else Header.of(self._raw)
        return self._header


class ReadsHistory(Reads[T]):
    """Reader that keeps the newest `length` messages."""

    def __init__(self, channel: str, message_type: type[T], length: int) -> None:
        super().__init__(channel, message_type)
        self._history = History(length, self._decode)

    def _freeze(self, fresh: list[bytes]) -> None:
        super()._freeze(fresh)
        self._history.add(fresh)

    @property
    def value(self) -> T:
        """Newest message; a copy that belongs to this reader, and the last of the history."""
        return self._history[-1] if self._history else super().value

    @property
    def history(self) -> Sequence[T]:
        """The newest messages, oldest first; empty after a restart."""
        return self._history

    def _keep(self, length: int) -> None:
        """Keeps at least `length` messages from now on."""
        self._history.keep(length)


class History(Sequence[T]):
    """The newest messages of a channel; each is decoded when it is first accessed."""

    def __init__(self, length: int, decode: Callable[[bytes], T]) -> None:
        self._decode = decode
        self._raw: deque[bytes] = deque(maxlen=length)
        self._values: deque[T | None] = deque(maxlen=length)

    def keep(self, length: int) -> None:
        """Keeps at least `length` messages from now on."""
        if length > (self._raw.maxlen or 0):
            self._raw, self._values = deque(self._raw, length), deque(self._values, length)

    def add(self, fresh: Sequence[bytes]) -> None:
        """Appends newer messages; the oldest are dropped."""
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

    All messages of an iteration are sent together at its end; if the iteration fails, none is sent.
    """

    def __init__(self, channel: str, message_type: type[T], stamp: Stamp | None = None) -> None:
        self.channel = channel
        self.message_type = message_type
        self.value: T = message_type()
        self.sequence = 0
        """Sequence number of the newest message that was sent."""
        self._stamp = stamp or Stamp("")
        self._pending: list[bytes] = []  # written in this iteration, oldest first
        self._encode: Callable[[T], bytes] = messages.encoder(cast(Any, message_type), channel)

    def write(self) -> None:
        """Stamps and encodes `value` as it is now; the message is sent at the end of the iteration.

        Raises:
            MessageError: a field holds a value that its type cannot.
        """
        stamp = self._stamp
        header: header_t = self.value.header  # type: ignore[attr-defined]  # WritesPlain is for types without a header
        header.tick = stamp.tick
        header.stage = stamp.stage
        header.time_us = stamp.time_us
        header.writer = stamp.writer
        header.sequence = self.sequence + len(self._pending) + 1
        self._pending.append(self._encode(self.value))

    def _take(self) -> list[bytes]:
        """Ends an iteration; returns the messages to send, oldest first."""
        taken, self._pending = self._pending, []
        self.sequence += len(taken)
        return taken

    def _drop(self) -> None:
        """Drops the messages of an iteration that failed."""
        self._pending = []


class WritesPlain(Writes[T]):
    """Writer of a channel whose type has no header: the envelope around the value is stamped."""

    def write(self) -> None:
        """Encodes `value` as it is now; the message is sent at the end of the iteration.

        Raises:
            MessageError: a field holds a value that its type cannot.
        """
        stamp, sequence = self._stamp, self.sequence + len(self._pending) + 1
        plain = self._encode(self.value)
        self._pending.append(envelope.wrapped(plain, stamp.tick, sequence, stamp.time_us, stamp.stage, stamp.writer))


def channel(name: str = "", *, history: int = 0) -> Any:
    """Names the channel of a port in the class, where it is not `<namespace>/<attribute>`.

    The launch file overrides the name.

    Args:
        name: With a slash it is used as it is (`cyan1/odometry`), without one it belongs to the component's namespace.
            For `Each` it is a pattern with `*` for the namespace (`*/motor`).
        history: How many of the newest messages a reader keeps.
    """
    return ChannelDefault(name, history)


class ChannelDefault:
    """Value of the class attribute until the framework replaces it with the port."""

    def __init__(self, name: str, history: int = 0) -> None:
        self.name = name
        self.history = history
