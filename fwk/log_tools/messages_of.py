"""Decoded messages of a log, for exports and plots."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import Event
from fwk.lcm.messages import Header, type_name
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import MessageType, decoded, types_of
from fwk.log_tools.cut import EVENTS_PER_CALL, Progress
from fwk.log_tools.selection import Selection


class Decoded(NamedTuple):
    """A decoded message of a log."""

    event: Event
    kind: MessageType
    message: Any
    header: Header | None
    """Header of the stamp, if the type has none."""


class Messages:
    """Decoded messages of a log, in its order; stamps are part of their messages.

    Raises:
        LogError: the log cannot be read.
    """

    def __init__(self, log: Path, selection: Selection, progress: Progress = lambda _: None) -> None:
        self._reader = StampedLog(log)
        self._selection = selection
        self._progress = progress
        self.undecodable: dict[str, int] = {}
        """Channels with messages of no known type, or that do not decode, with their numbers."""

    @property
    def damaged_bytes(self) -> int:
        """Bytes that hold no whole event."""
        return self._reader.skipped_bytes

    def __iter__(self) -> Iterator[Decoded]:
        for number, event in enumerate(self._reader):
            if not number % EVENTS_PER_CALL:
                self._progress(self._reader.position)
            if event.channel == STAMP or not self._selection.takes(event):
                continue
            try:
                message = decoded(event.data)
            except Exception:  # unknown type, or any error of generated code on broken bytes
                self.undecodable[event.channel] = self.undecodable.get(event.channel, 0) + 1
                continue
            header = Header.of(event.data) if event.in_envelope else None
            yield Decoded(event, types_of(event.data)[0], message, header)
        self._reader.check_any()
        self._selection.check(str(self._reader.path))


def names_of(found: Decoded) -> tuple[str, str]:
    """Returns channel and type of a message."""
    return found.event.channel, type_name(found.kind)
