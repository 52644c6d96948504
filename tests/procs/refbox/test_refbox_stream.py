"""Messages of a RefBox however the network cuts them, and what is too long or no JSON."""

import json
from collections.abc import Iterator

import pytest

from procs.refbox.protocol import LONGEST, Addresses, ProtocolError, Stream, decode
from procs.refbox.world_state import check

TEAMS = Addresses().model_dump()
LONG = b"x" * (LONGEST + 1)
START = b'{"command": "START"}'


def parts(data: bytes, size: int) -> Iterator[bytes]:
    return (data[start : start + size] for start in range(0, len(data), size))


def heard(data: bytes, size: int) -> tuple[list[bytes], int]:
    """Returns the messages of a connection, and how many were too long."""
    stream, messages, refused = Stream(), list[bytes](), 0
    for part in parts(data, size):
        try:
            for message in stream.feed(part):
                messages.append(message)
        except ProtocolError:
            refused += 1
    return messages, refused


@pytest.mark.parametrize("size", [LONGEST // 3, LONGEST - 1, LONGEST, 4 * LONGEST])
def test_long_message_is_refused_once_wherever_it_is_cut(size: int) -> None:
    assert heard(START + b"\0" + LONG + b"\0" + START + b"\0", size) == ([START, START], 1)
    assert heard(b"y" * LONGEST + b"\0", size) == ([b"y" * LONGEST], 0)


@pytest.mark.parametrize("size", [1000, LONGEST, 4 * LONGEST])
def test_end_of_a_long_message_is_no_command(size: int) -> None:
    assert heard(LONG * 3 + START + b"\0", size) == ([], 1)


@pytest.mark.parametrize("size", [1, 2, 7])
def test_messages_are_the_same_in_small_parts(size: int) -> None:
    data = b"\0".join((START, b"", b" ", START, b"ab"))
    assert heard(data, size) == ([START, START], 0)


@pytest.mark.parametrize("number", ["NaN", "Infinity", "-Infinity"])
def test_numbers_that_json_does_not_know_are_refused(number: str) -> None:
    with pytest.raises(ProtocolError, match="is not JSON"):
        decode(b'{"command": "START", "robotID": %s}' % number.encode(), TEAMS)
    report = {"type": "worldstate", "teamName": "A", "intention": "", "robots": [], "balls": [], "ageMs": 0}
    with pytest.raises(ProtocolError, match="is not JSON"):
        check((json.dumps(report)[:-1] + f', "obstacles": [{number}]}}').encode())


@pytest.mark.parametrize(("opened", "end"), [(b"[", b""), (b"[", b"]"), (b'{"a":', b""), (b'{"a":', b"}")])
def test_deep_nests_are_no_command(opened: bytes, end: bytes) -> None:
    depth = LONGEST // len(opened + end) - 1
    with pytest.raises(ProtocolError, match=r"is not JSON|has no command"):
        decode(opened * depth + b"1" + end * depth, TEAMS)
