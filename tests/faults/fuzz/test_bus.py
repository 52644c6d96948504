"""Decoders turn any bytes into a message or refuse them."""

import struct
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as some

from fwk.lcm import messages, wire
from fwk.lcm.messages import Header, MessageError, to_dict
from tests.harness.fuzz import DECODERS, all_types, damaged, sync_messages

PARTS = wire.datagrams(7, b"a/large", bytes(range(256)) * 600)
LONG = struct.Struct(">4sIIIHH")


@pytest.mark.parametrize("kind", DECODERS, ids=lambda kind: kind.__name__)
@given(some.data())
def test_the_codec_decodes_like_lcm_gen(kind: type[Any], data: some.DataObject) -> None:
    bytes_ = data.draw(damaged(sync_messages()[kind]))
    try:
        ours = to_dict(DECODERS[kind](bytes_))
    except MessageError:
        return  # stricter than lcm-gen, which pads a cut string
    theirs = to_dict(kind.decode(bytes_))
    for events in ("events", "n_events"):  # replay decides about it
        ours.pop(events, None)
        theirs.pop(events, None)
    assert ours == theirs


@given(some.binary(max_size=120))
def test_no_bytes_of_any_type_break_a_reader(data: bytes) -> None:
    for kind in all_types():
        with suppress(MessageError):
            messages.decode(kind, messages.fingerprint(kind) + data, "a/channel")
    with suppress(MessageError):
        Header.of(data)


@given(some.lists(some.sampled_from(PARTS).flatmap(damaged) | some.sampled_from(PARTS), max_size=6), some.data())
def test_fragments_become_a_whole_message_or_none(parts: list[bytes], data: some.DataObject) -> None:
    assembler = wire.Assembler()
    order = data.draw(some.permutations([*parts, *PARTS]))
    for part in order:
        try:
            made = assembler.feed(part, data.draw(some.integers(1, 2)))
        except MessageError:
            continue
        assert made is None or isinstance(made[1], bytes)


def test_a_fragment_of_a_huge_message_takes_no_memory() -> None:
    assembler = wire.Assembler()
    for number in range(1000):
        assembler.feed(LONG.pack(b"LC03", number, 255 << 20, 0, 0, 60_000) + b"a\0", 1)
    assert assembler._bytes == 0
    assert len(assembler._unfinished) <= 64


def test_unfinished_messages_take_bounded_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(wire, "_UNFINISHED_BYTES_MAX", 100_000)
    assembler = wire.Assembler()
    for number in range(10):
        assembler.feed(LONG.pack(b"LC03", number, 200_000, 0, 0, 4) + b"a\0" + bytes(30_000), 1)
    assert assembler._bytes <= 100_000
    assert (1, 9) in assembler._unfinished
    assert (1, 0) not in assembler._unfinished


@pytest.mark.parametrize("offsets", [(0, 65_000), (0, 66_000)])
def test_overlapping_or_incomplete_fragments_are_refused(offsets: tuple[int, int]) -> None:
    assembler, body = wire.Assembler(), bytes(65_485)
    size = offsets[1] + len(body)
    assembler.feed(LONG.pack(b"LC03", 1, size, offsets[0], 0, 2) + b"a\0" + body, 1)
    with pytest.raises(MessageError, match="is next"):
        assembler.feed(LONG.pack(b"LC03", 1, size, offsets[1], 1, 2) + body, 1)
    assert assembler._bytes == 0
