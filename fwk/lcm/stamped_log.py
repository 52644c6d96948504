"""Reads logs with messages of types without the header put back into their envelopes."""

from collections.abc import Iterator

from fwk.lcm import envelope, messages
from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import Event, LogReader
from fwk.lcm.messages import MessageError
from lcmtypes.core import header_t, stamp_t

_decode = messages.decoder(stamp_t, STAMP)


class StampedLog(LogReader):
    """A log whose stamps are joined to their messages; the stamps themselves are events as well.

    A stamp belongs to the next message on its channel; a logger elsewhere may have put messages of other programs in
    between. Stamps before damage are not used after it.
    """

    def __iter__(self) -> Iterator[Event]:
        stamps: dict[str, header_t] = {}
        skipped = 0
        for event in super().__iter__():
            if skipped != self.skipped_bytes:
                skipped = self.skipped_bytes
                stamps.clear()
            if event.channel == STAMP:
                stamp = stamp_in(event.data)
                if stamp:
                    stamps[stamp.channel] = stamp.header
            elif header := stamps.pop(event.channel, None):
                numbers = header.tick, header.sequence, header.time_us, header.stage
                joined = envelope.wrapped(event.data, *numbers, header.writer)
                yield event._replace(data=joined, in_envelope=True)
                continue
            yield event


def stamp_in(data: bytes) -> stamp_t | None:
    """Returns the stamp of an event; None if it is damaged."""
    try:
        stamp: stamp_t = _decode(data)
    except MessageError:
        return None
    return stamp
