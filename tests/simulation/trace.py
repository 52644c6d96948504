"""Events of a simulated world, step by step, for people."""

from collections.abc import Callable, Iterator

from fwk.bus import sync
from fwk.lcm import type_registry, wire
from fwk.lcm.messages import Header, to_dict
from lcmtypes.core import actual_t, fetch_t, gone_t, log_t, status_t

Line = tuple[int, str, str, bytes | None]
"""Wall time, process, text, and the datagram if there is one."""

_TYPES: dict[bytes, Callable[[bytes], object]] = {
    sync.TICK: sync.decode_tick,
    sync.DONE: sync.decode_done,
    sync.RECORD: sync.decode_record,
    sync.RECORDED: sync.decode_recorded,
    sync.TAKEN: sync.decode_taken,
    sync.LEAVING: sync.decode_leaving,
    sync.ANNOUNCE: sync.decode_announcement,
    sync.FETCH_RECORDS: sync.decode_fetch_records,
    b"fwk/fetch": fetch_t.decode,
    b"fwk/gone": gone_t.decode,
    b"fwk/actual": actual_t.decode,
    b"fwk/log": log_t.decode,
    b"fwk/status": status_t.decode,
}


class Trace:
    """Collects lines while it is `on`; collecting is cheap, lines are formatted when they are read."""

    def __init__(self, on: bool) -> None:
        self.on = on
        self._lines: list[Line] = []

    def add(self, time_us: int, process: str, text: str, datagram: bytes | None = None) -> None:
        """Adds a line."""
        if self.on:
            self._lines.append((time_us, process, text, datagram))

    def lines(self, start_us: int) -> Iterator[str]:
        """Returns every line in words, with times counted from `start_us`."""
        for time_us, process, text, datagram in self._lines:
            said = f" {words_of(datagram)}" if datagram is not None else ""
            yield f"{(time_us - start_us) / 1000:11.3f} ms  {process:<16} {text}{said}"


def words_of(datagram: bytes) -> str:
    """Returns a datagram's contents in one line."""
    if not wire.is_short(datagram):
        return f"fragment of {len(datagram)} bytes"
    channel, _, data = datagram[8:].partition(b"\0")
    decode = _TYPES.get(channel)
    return f"{channel.decode()} {_plain(to_dict(decode(data)))}" if decode else message_words(channel.decode(), data)


def message_words(channel: str, data: bytes) -> str:
    """Returns the identity of a message in one line."""
    if not type_registry.is_interface(data):
        return f"{channel}: {len(data)} bytes"
    header = Header.of(data)
    return f"{channel} #{header.sequence} of tick {header.tick}, stage {header.stage}, by {header.writer}"


def _plain(value: object) -> str:
    """Returns fields in the order of their declaration, without counts, empty fields and the run's number."""
    if isinstance(value, dict):
        said = [
            f"{name}={_plain(item)}"
            for name, item in value.items()
            if item not in ([], "", b"", {})
            and item != {"n": 0}
            and name not in ("run", "times", "wall_us")
            and not name.startswith("n_")
        ]
        return "{" + " ".join(said) + "}"
    if isinstance(value, list):
        return "[" + " ".join(map(_plain, value)) + "]"
    return str(value)
