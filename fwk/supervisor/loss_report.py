"""Messages and frames that readers did not get, on their way from a done into the record of the tick."""

from fwk.model.tick_events import FrameLost, MessageLost
from fwk.supervisor.tick_log import Records
from lcmtypes.core import done_t


class Missed:
    """Writes them down, so that a replay keeps the same from the same readers."""

    def __init__(self, records: Records) -> None:
        self._records = records

    def take(self, done: done_t) -> None:
        """Writes down what a done reports as lost; to be called before the done itself is written down."""
        for message in done.lost:
            self._records.event(MessageLost(done.host, message.channel, message.sequence))
        for frame in done.lost_frames:
            self._records.event(FrameLost(frame.component, frame.channel, frame.frame))
