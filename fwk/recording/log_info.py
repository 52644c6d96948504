"""Reads the contents of a log: from its index at once, or message by message."""

from collections.abc import Callable
from pathlib import Path

from fwk.lcm.log_parts import is_later_part
from fwk.lcm.stamped_log import StampedLog
from fwk.recording.log_contents import ChannelInfo, LogInfo, excerpt_in, note_in
from fwk.recording.log_index import LogIndex, changed
from fwk.recording.missing_parts import missing_parts

_EVENTS_PER_CALL = 1000


def log_info(path: Path, check: bool = False, progress: Callable[[int], None] = lambda _: None) -> LogInfo:
    """Returns the contents of a log.

    Args:
        path: the log.
        check: reads and decodes every message, and compares the check sums, although the log has an index.
        progress: takes the number of bytes read so far.

    Raises:
        LogError: the file cannot be read or is not a log.
    """
    reader = StampedLog(path)
    index = LogIndex.of(path)
    if index and not check and index.is_current():
        return index.info
    info = _read(reader, progress)
    info.changed = changed(path)
    info.missing = missing_parts(path)
    info.dropped -= sum(each.events for each in info.missing)
    return info


def _read(reader: StampedLog, progress: Callable[[int], None]) -> LogInfo:
    """Reads a log from beginning to end and decodes every message."""
    info, channels = LogInfo(reader.path), dict[str, ChannelInfo]()
    following: int | None = None if is_later_part(reader.path) else 0
    for event in reader:
        info.first_us = min(info.first_us, event.time_us) if info.events else event.time_us
        info.last_us = max(info.last_us, event.time_us) if info.events else event.time_us
        info.events += 1
        info.dropped += max(0, event.number - following) if following is not None and not reader.skipped_bytes else 0
        following = event.number + 1
        channels.setdefault(event.channel, ChannelInfo()).add(event)
        info.excerpt = excerpt_in(event.channel, event.data) or info.excerpt
        if note := note_in(event.channel, event.data):
            info.notes.append(note)
        if not info.events % _EVENTS_PER_CALL:
            progress(reader.position)
    info.size_bytes, info.damaged_bytes = reader.size_bytes, reader.skipped_bytes
    reader.check_any()
    info.channels = dict(sorted(channels.items()))
    return info
