"""Writes messages and frames that components lost into the record of the tick."""

from fwk.model.tick_events import FrameLost, MessageLost
from fwk.supervisor.tick_log import TickLog
from lcmtypes.core import done_t


def record_losses(done: done_t, tick_log: TickLog) -> None:
    """Records the losses that a done reports, before the done itself is recorded.

    A replay withholds the same messages and frames from the same components.
    """
    for message in done.lost:
        tick_log.event(MessageLost(done.host, message.channel, message.sequence))
    for frame in done.lost_frames:
        tick_log.event(FrameLost(frame.component, frame.channel, frame.frame))
