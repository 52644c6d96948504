"""Requests to a program and its answers: JSON lines for any language, or LCM messages for programs with fwk.h."""

import json
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

from fwk.component.channels import Reads, Writes
from fwk.component.child_process import ProgramError
from fwk.component.program_services import ServedPort, ServicePort
from fwk.lcm import envelope, messages

INIT, FINAL = "init", "final"
"""Stages of the first and the last request of a program's life."""
_HEAD = struct.Struct(">IIqqqI")  # length of the rest, kind, tick, time and period in microseconds, number of parts
_COUNT = struct.Struct(">II")  # length of the rest, number of parts
_PART = struct.Struct(">II")  # port, size
_KINDS = {INIT: 0, FINAL: 2}
_ITERATION = 1
_FRAMEWORKS = ("header", "command", "answer")
"""Members of messages that the framework writes."""


@dataclass(frozen=True)
class ProgramRequest:
    """Request to a program for one iteration."""

    stage: str
    """Stage of the iteration, `INIT` or `FINAL`."""
    tick: int
    time_us: int
    period_us: int
    readers: Mapping[str, Reads[Any] | ServicePort]
    """By port; their fresh messages, requests and answers are sent."""
    more: Mapping[str, Any] = field(default_factory=dict)
    """In the first request the component's name, ports and settings; later the settings after a change."""


class Coding(Protocol):
    """A form of requests and answers."""

    def request(self, asked: ProgramRequest) -> bytes:
        """Returns a request as bytes."""

    def length_of(self, begun: bytearray, searched: int) -> int:
        """Returns the length of an answer; 0 if it is not known yet, as it was not in the first `searched` bytes."""

    def answer(self, data: bytes, writers: Mapping[str, Writes[Any] | ServicePort]) -> list[tuple[str, Any]]:
        """Returns the messages of an answer, each with its port.

        Raises:
            ProgramError: the answer is not valid.
        """


class JsonLines:
    """One line of JSON for each request and each answer."""

    def request(self, asked: ProgramRequest) -> bytes:
        """Returns an object with tick, stage, time and inputs; NaN and infinity are written as Python's json does."""
        inputs = {
            port: [messages.to_dict(each) for each in reader.fresh] if isinstance(reader, Reads) else reader.plain()
            for port, reader in asked.readers.items()
        }
        told = {"tick": asked.tick, "stage": asked.stage, "time_us": asked.time_us, **asked.more}
        told["inputs"] = {port: fresh for port, fresh in inputs.items() if fresh}
        return json.dumps(told, default=list).encode() + b"\n"

    def length_of(self, begun: bytearray, searched: int) -> int:
        """Returns the length up to the first line end, which does not lie in the first `searched` bytes."""
        return begun.find(b"\n", searched) + 1

    def answer(self, data: bytes, writers: Mapping[str, Writes[Any] | ServicePort]) -> list[tuple[str, Any]]:
        """Reads an object with a message, or a list of messages, by port.

        Raises:
            ProgramError: the line is not such an object, or a port or field does not exist.
        """
        line = data.decode(errors="replace").strip()
        try:
            found = json.loads(line)
        except (ValueError, RecursionError):
            found = None
        if not isinstance(found, dict):
            raise ProgramError(f"the answer {_short(line)} is not a JSON object such as {{}}")
        made = []
        for port, value in found.items():
            if port not in writers:
                raise ProgramError(f"the answer has the port '{port}'; the program writes {_listed(writers)}")
            for members in value if isinstance(value, list) else [value]:
                made.append((port, _message(writers[port], port, members)))
        return made


class LcmFrames:
    """Binary requests and answers with encoded LCM messages, as fwk.h reads and writes them."""

    def request(self, asked: ProgramRequest) -> bytes:
        """Returns length, kind, tick, time, period, and each fresh message with the number of its port."""
        parts = [
            (number, data)
            for number, reader in enumerate(asked.readers.values())
            for data in (_contents(reader) if isinstance(reader, Reads) else reader.encoded())
        ]
        if asked.stage == INIT:
            ports = [("r", name) for name in asked.more["reads"]] + [("w", name) for name in asked.more["writes"]]
            texts = [("n", asked.more["name"]), *ports, ("s", json.dumps(asked.more["settings"]))]
            parts = [(ord(kind), text.encode()) for kind, text in texts]
        body = b"".join(_PART.pack(number, len(data)) + data for number, data in parts)
        kind = _KINDS.get(asked.stage, _ITERATION)
        length = _HEAD.size - 4 + len(body)
        return _HEAD.pack(length, kind, asked.tick, asked.time_us, asked.period_us, len(parts)) + body

    def length_of(self, begun: bytearray, _searched: int) -> int:
        """Returns the length that the first four bytes name."""
        return 4 + int.from_bytes(begun[:4], "big") if len(begun) >= _COUNT.size else 0

    def answer(self, data: bytes, writers: Mapping[str, Writes[Any] | ServicePort]) -> list[tuple[str, Any]]:
        """Reads the messages, each with the number of its port.

        Raises:
            ProgramError: the answer is not of this form, or a message is not of its port's type.
        """
        made: list[tuple[str, Any]] = []
        ports, place = list(writers), _COUNT.size
        try:
            for _ in range(_COUNT.unpack_from(data)[1]):
                number, size = _PART.unpack_from(data, place)
                place += _PART.size
                port = ports[number]
                made.append((port, messages.decode(writers[port].message_type, data[place : place + size], port)))
                place += size
        except (struct.error, IndexError) as error:
            raise ProgramError("the answer is not of the form that fwk.h writes") from error
        except messages.MessageError as error:
            raise ProgramError(str(error)) from error
        if place != len(data):
            raise ProgramError(f"the answer has {len(data) - place} bytes more than its messages")
        return made


CODINGS: dict[str, Coding] = {"json": JsonLines(), "lcm": LcmFrames(), "files": JsonLines()}


def _contents(reader: Reads[Any]) -> list[bytes]:
    if messages.has_header(reader.message_type):
        return reader._fresh
    return [envelope.content(data) for data in reader._fresh]


def _message(writer: Writes[Any] | ServicePort, port: str, members: Any) -> Any:
    if not isinstance(members, dict):
        raise ProgramError(
            f"'{port}' of the answer is {_short(json.dumps(members))}; it should be a message as an object"
        )
    if isinstance(writer, ServedPort):
        reply = members.get("reply", {})
        return writer.answer_of(members, _message_of(writer.message_type, port, reply))
    return _message_of(writer.message_type, port, members)


def _message_of(kind: type[Any], port: str, members: Any) -> Any:
    if not isinstance(members, dict):
        raise ProgramError(f"the reply in '{port}' is {_short(json.dumps(members))}; it should be an object")
    own = {name: value for name, value in members.items() if name not in _FRAMEWORKS}
    try:
        return messages.of_dict(kind, own)
    except messages.MessageError as error:
        raise ProgramError(f"'{port}' of the answer: {error}") from error


def _listed(names: Mapping[str, object] | Sequence[str]) -> str:
    return ", ".join(names) or "nothing"


def _short(text: str) -> str:
    return repr(text if len(text) <= 80 else f"{text[:77]}...")
