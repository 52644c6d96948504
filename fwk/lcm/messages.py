"""LCM types and messages: fingerprints, headers in raw bytes, counts, and readable errors."""

import struct
from collections.abc import Callable, Mapping, Sized
from importlib import import_module
from typing import Any, ClassVar, Protocol, Self, cast, runtime_checkable

from fwk.lcm import codec
from fwk.lcm.lcm_file import RENAMED
from lcmtypes.core import header_t


class Message(Protocol):
    """A class that lcm-gen generated."""

    __slots__: ClassVar[list[str]]
    __typenames__: ClassVar[list[str]]
    __dimensions__: ClassVar[list[list[int | str] | None]]

    def encode(self) -> bytes: ...
    @staticmethod
    def decode(data: bytes) -> Any: ...
    @staticmethod
    def _get_packed_fingerprint() -> bytes: ...


@runtime_checkable
class Stamped(Protocol):
    """A message of an interface, whose first member is the header."""

    header: header_t


class MessageError(Exception):
    """A message cannot be encoded or decoded; the text names channel, type and field."""


_NUMBERS = struct.Struct(">qqqhI")  # tick, sequence, time_us, stage, length of the writer's name with its zero byte
_TICK_AND_SEQUENCE: Callable[[bytes, int], tuple[int, int]] = struct.Struct(">qq").unpack_from
_FINGERPRINT_SIZE = 8
HEADER_SIZE = _FINGERPRINT_SIZE + _NUMBERS.size


class Header:
    """Header of a message, read from the raw bytes without decoding the rest."""

    __slots__ = ("end", "sequence", "stage", "tick", "time_us", "writer")

    def __init__(self, tick: int, sequence: int, time_us: int, stage: int, writer: str, end: int) -> None:
        self.tick = tick
        self.sequence = sequence
        self.time_us = time_us
        self.stage = stage
        self.writer = writer
        self.end = end  # where the message's own fields begin

    @classmethod
    def of(cls, data: bytes) -> Self:
        """Reads the header.

        Raises:
            MessageError: the bytes end before the header does.
        """
        if len(data) < HEADER_SIZE:
            raise MessageError(f"message of {len(data)} bytes is shorter than its header")
        tick, sequence, time_us, stage, length = _NUMBERS.unpack_from(data, _FINGERPRINT_SIZE)
        end = HEADER_SIZE + length
        if length < 1 or len(data) < end:
            raise MessageError(f"message of {len(data)} bytes is shorter than its header")
        return cls(tick, sequence, time_us, stage, data[HEADER_SIZE : end - 1].decode("utf-8", "replace"), end)

    @property
    def incarnation(self) -> int:
        """Incarnation of the writer, which follows '#' in its name; 1: no number."""
        _, _, number = self.writer.rpartition("#") if "#" in self.writer else ("", "", "1")
        return int(number)


def sequence_of(data: bytes) -> int:
    """Returns the sequence number of an encoded message of at least `HEADER_SIZE` bytes."""
    return int.from_bytes(data[16:24], "big", signed=True)


def tick_and_sequence_of(data: bytes) -> tuple[int, int]:
    """Returns tick and sequence number of an encoded message of at least `HEADER_SIZE` bytes."""
    return _TICK_AND_SEQUENCE(data, _FINGERPRINT_SIZE)


def type_name(message_type: type[Message]) -> str:
    """Returns the name of a type as in .lcm files: `core.frame_t`."""
    return f"{message_type.__module__.removeprefix('lcmtypes.').split('.')[0]}.{message_type.__name__}"


def current_name(name: str) -> str:
    """Returns the present name of a type that may have been renamed: `core.frame_t` for `robot.frame_t`."""
    return RENAMED.get(name, name)


def type_named(name: str) -> type[Message]:
    """Finds the generated class of `core.frame_t`, also by a former name.

    Raises:
        MessageError: there is no such type.
    """
    package, _, short = current_name(name).rpartition(".")
    try:
        found: type[Message] = getattr(import_module(f"lcmtypes.{package}"), short)
    except (ImportError, AttributeError) as error:
        raise MessageError(f"no LCM type '{name}' in lcmtypes/") from error
    return found


def fingerprint(message_type: type[Message]) -> bytes:
    """Returns the first eight bytes of every message of a type."""
    return message_type._get_packed_fingerprint()


def is_same_type(one: type[Message], other: type[Message]) -> bool:
    """Returns whether fingerprint and name agree; types with equal members have the same fingerprint."""
    return fingerprint(one) == fingerprint(other) and type_name(one) == type_name(other)


def has_header(message_type: type[Message]) -> bool:
    """Returns whether a type is an interface, whose first member is the header."""
    return list(message_type.__slots__[:1]) == ["header"] and message_type.__typenames__[0].endswith("core.header_t")


def has_second(message_type: type[Message], name: str, kind: str) -> bool:
    """Returns whether the second member of a type is `kind name;`, as in requests and replies."""
    return message_type.__slots__[1:2] == [name] and message_type.__typenames__[1].endswith(kind)


def decode(message_type: type[Message], data: bytes, channel: str) -> Any:
    """Decodes a message.

    Raises:
        MessageError: the bytes are damaged or of another type; the text names channel and fingerprints.
    """
    return decoder(message_type, channel)(data)


def decoder(message_type: type[Message], channel: str) -> Callable[[bytes], Any]:
    """Returns the function that decodes messages of a channel."""
    decode = codec.decoder(message_type) or message_type.decode

    def decoded(data: bytes) -> Any:
        try:
            return decode(data)
        except Exception as error:
            expected, found = fingerprint(message_type).hex(), data[:8].hex()
            reason = (
                f"fingerprint {found}, expected {expected}"
                if found != expected
                else f"{len(data)} bytes do not decode: {error}"
            )
            raise MessageError(f"{channel}: not a {type_name(message_type)}: {reason}") from error

    return decoded


def encode(message: Message, channel: str) -> bytes:
    """Encodes a message after setting its counts to the lengths of its lists.

    Raises:
        MessageError: a field holds a value that its type cannot; the text names channel, field, type and value.
    """
    return encoder(type(message), channel)(message)


def encoder(message_type: type[Message], channel: str) -> Callable[[Any], bytes]:
    """Returns the function that encodes messages of a channel."""
    encode = codec.encoder(message_type) or _counted_and_encoded

    def encoded(message: Any) -> bytes:
        try:
            return encode(message)
        except Exception as error:
            raise MessageError(
                f"{channel}: cannot encode {type_name(message_type)}: {_culprit(message, message_type) or error}"
            ) from error

    return encoded


def _counted_and_encoded(message: Message) -> bytes:
    set_counts(message)
    return message.encode()


def set_counts(message: Message) -> None:
    """Sets each count field to the length of the lists that it counts; lcm-gen leaves that to the caller."""
    cls = type(message)
    plan = _PLANS.get(cls)
    if plan is None:
        plan = _PLANS[cls] = _plan(cls)
    counted, nested = plan
    lengths: dict[str, int] = {}
    for name, count in counted:
        length = len(getattr(message, name))
        if lengths.setdefault(count, length) != length:
            raise ValueError(f"the lists counted by '{count}' differ in length")
        setattr(message, count, length)
    for name, is_list in nested:
        value = getattr(message, name)
        for item in value if is_list else (value,):
            set_counts(item)


_PLANS: dict[type, tuple[list[tuple[str, str]], list[tuple[str, bool]]]] = {}


def _plan(cls: type[Message]) -> tuple[list[tuple[str, str]], list[tuple[str, bool]]]:
    counted, nested = [], []
    for name, kind, dimensions in zip(cls.__slots__, cls.__typenames__, cls.__dimensions__, strict=True):
        if dimensions and isinstance(dimensions[0], str):
            counted.append((name, dimensions[0]))
        if "." in kind and name != "header" and len(dimensions or []) <= 1:
            nested.append((name, bool(dimensions)))
    return counted, nested


_CODES = {"int8_t": "b", "int16_t": "h", "int32_t": "i", "int64_t": "q", "float": "f", "double": "d", "boolean": "?"}
_SHOWN = 60  # characters of a value that does not fit


def _culprit(message: Any, message_type: type[Message], path: str = "") -> str:
    """Returns the first member whose value does not fit, such as `points[2].x_m is 'a', not a double`."""
    if not isinstance(message, message_type):
        where = f"{path} is" if path else "it is"
        return f"{where} a {type(message).__name__}, not a {type_name(message_type)}"
    for name, kind, dimensions in zip(message.__slots__, message.__typenames__, message.__dimensions__, strict=True):
        full = f"{path}.{name}" if path else name
        if not hasattr(message, name):
            return f"{full} is missing"
        value = getattr(message, name)
        if wrong := _wrong_shape(value, dimensions or [], full) or _wrong_value(value, kind, dimensions or [], full):
            return wrong
    return ""


def _wrong_shape(value: Any, dimensions: list[int | str], path: str) -> str:
    """Returns the mistake in the sizes of an array; `?` means a size that may vary."""
    wanted = [size if isinstance(size, int) else "?" for size in dimensions]
    found = _shape(value, len(dimensions))
    if len(found) == len(wanted) and all(b in ("?", a) for a, b in zip(found, wanted, strict=True)):
        return ""
    right = f"it should be an array of {' x '.join(map(str, wanted))}"
    if not found:
        return f"{path} is {_brief(value)}; {right}"
    return f"{path} is an array of {' x '.join(map(str, found))}; {right}"


def _shape(value: Any, depth: int) -> list[int]:
    """Returns the sizes of nested sequences; of ragged ones the first that differs."""
    if not depth or isinstance(value, str) or not isinstance(value, Sized):
        return []
    if isinstance(value, bytes | bytearray):
        return [len(value)]
    inner = [_shape(item, depth - 1) for item in cast("list[Any]", value)]
    return [
        len(value),
        *(next((shape for shape in inner if shape != inner[0]), inner[0]) if inner else [0] * (depth - 1)),
    ]


def _wrong_value(value: Any, kind: str, dimensions: list[int | str], path: str) -> str:
    if dimensions:
        if isinstance(value, bytes | bytearray):
            return ""
        items = (_wrong_value(item, kind, dimensions[1:], f"{path}[{index}]") for index, item in enumerate(value))
        return next(filter(None, items), "")
    if kind in _CODES:
        try:
            struct.pack(">" + _CODES[kind], value)
        except (struct.error, OverflowError, TypeError):
            return f"{path} is {_brief(value)}, not {_article(kind)} {kind}"
    elif kind == "string":
        if not isinstance(value, str):
            return f"{path} is {_brief(value)}, not a string"
    elif kind != "byte":
        return _culprit(value, type_named(kind.removeprefix("lcmtypes.")), path)
    return ""


def _article(kind: str) -> str:
    return "an" if kind.startswith("int") else "a"


def _brief(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."


def to_dict(message: Any) -> Any:
    """Returns a message as plain dicts, lists and values."""
    if hasattr(message, "__typenames__"):
        return {name: to_dict(getattr(message, name)) for name in message.__slots__}
    if isinstance(message, (list, tuple)):
        return [to_dict(item) for item in message]
    return message


def of_dict(message_type: type[Message], members: Mapping[str, Any]) -> Any:
    """Returns a message of members given as plain data; a dict becomes a struct, a list of dicts an array of them.

    Raises:
        MessageError: the type has no such member.
    """
    made: Any = message_type()
    kinds = dict(zip(made.__slots__, made.__typenames__, strict=True))
    for name, value in members.items():
        if name not in kinds:
            known = ", ".join(kinds)
            raise MessageError(f"{type_name(message_type)} has no field '{name}'; its fields are {known}")
        setattr(made, name, _of_plain(kinds[name], value))
    return made


def _of_plain(kind: str, value: Any) -> Any:
    if "." in kind and isinstance(value, Mapping):
        return of_dict(type_named(kind.removeprefix("lcmtypes.")), value)
    if "." in kind and isinstance(value, list | tuple):
        return [_of_plain(kind, item) for item in value]
    return value
