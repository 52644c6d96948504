"""Ticks that the messages of a log name."""

from fwk.lcm.envelope import STAMP
from fwk.lcm.messages import HEADER_SIZE, tick_and_sequence_of
from fwk.lcm.stamped_log import stamp_in
from fwk.lcm.type_registry import decoded, is_interface


def tick_of(channel: str, data: bytes) -> int | None:
    """Returns the tick that a message names: in its header, or as a tick record, log line, status or stamp."""
    if len(data) >= HEADER_SIZE and is_interface(data):
        return tick_and_sequence_of(data)[0]
    if not channel.startswith("fwk/"):
        return None
    if channel == STAMP:
        stamp = stamp_in(data)
        return stamp.header.tick if stamp else None
    try:
        tick: int | None = getattr(decoded(data), "tick", None)
    except Exception:  # unknown type, or any error of generated code on broken bytes
        return None
    return tick
