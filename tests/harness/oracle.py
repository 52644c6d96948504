"""Derives from the contract alone what every iteration of the orchestra must have seen, and finds violations.

Visible to an iteration (tick, stage) is every message of an earlier (tick, stage), and no other. An iteration sees
the messages that became visible since the last iteration of its process; the first iteration of a restarted player
sees the newest messages as of the tick in which its process joined the loop, and all later ones.
"""

import zlib
from collections.abc import Iterator
from typing import Any

from fwk.lcm.messages import Header, type_named
from tests.harness.logs import Recording
from tests.programs.orchestra import PLAYERS

_CHANNELS = [f"{player}/{kind}" for kind in ("note", "burst") for player in PLAYERS]


def contradictions(recording: Recording) -> list[str]:
    """Returns every note that contradicts the contract, in words."""
    found: list[str] = []
    for player in PLAYERS:
        found += _of_player(recording, player)
    return found


def _of_player(recording: Recording, player: str) -> Iterator[str]:
    written = {channel: [(header.tick, header.stage) for header in recording.headers(channel)] for channel in _CHANNELS}
    nothing = {kind: type_named(f"play.{kind}_t")().encode() for kind in ("note", "burst")}
    writer, digest, iterations, seen = "", 0, 0, dict.fromkeys(_CHANNELS, 0)
    for data, note in zip(recording.messages[f"{player}/note"], recording.decoded(f"{player}/note"), strict=True):
        header = Header.of(data)
        where = f"{header.writer} in tick {header.tick}, stage {header.stage}"
        again = header.writer != writer
        if again:
            writer, digest, iterations, seen = header.writer, 0, 0, dict.fromkeys(_CHANNELS, 0)
        before = 0
        for channel, heard in zip(_CHANNELS, note.heard, strict=True):
            visible = sum(at < (header.tick, header.stage) for at in written[channel])
            first = seen[channel] + 1
            if again and "#" in writer:
                first = heard.first if heard.count else visible + 1  # its writer may have died, too
            seen[channel] = visible
            yield from _compare(f"{where} heard of {channel}", heard, first, visible, written[channel])
            fresh = recording.messages[channel][first - 1 : visible]
            newest = recording.messages[channel][visible - 1] if visible and heard.newest_tick else None
            for message in [*fresh, newest or nothing[channel.partition("/")[2]]]:
                before = zlib.crc32(message, before)
        digest = zlib.crc32(before.to_bytes(8, "big"), digest)
        iterations += 1
        if note.digest != digest:
            yield f"{where}: saw other bytes than were recorded"
        if note.iterations != iterations:
            yield f"{where}: iteration {note.iterations}, not {iterations}"
        if not note.frozen:
            yield f"{where}: inputs changed during the iteration"


def _compare(where: str, heard: Any, first: int, last: int, written: list[tuple[int, int]]) -> Iterator[str]:
    right = (first, last, last - first + 1) if last >= first else (0, 0, 0)
    if (heard.first, heard.last, heard.count) != right:
        yield f"{where} messages {(heard.first, heard.last, heard.count)}, not {right}"
    newest = (heard.newest_tick, heard.newest_stage)
    if newest not in ((0, 0), written[last - 1] if last else (0, 0)):
        yield f"{where} a newest message of {newest}"
