"""Messages and frames that readers did not get, on their way from a done into the record of the tick."""

from fwk.engine.runner import MISSED_FRAMES
from fwk.model.plan import Plan
from fwk.supervisor.requests import Wishes
from fwk.supervisor.tick_log import Records
from lcmtypes.core import done_t, tick_event_t


class Missed:
    """Writes them down, so that a replay keeps the same from the same readers."""

    def __init__(self, plan: Plan, records: Records) -> None:
        self._components = {component.name: component.index for component in plan.components}
        self._channels = {channel.name: channel.index for channel in plan.channels if channel.images}
        self._records = records

    def take(self, done: done_t, wishes: Wishes) -> None:
        """What a host says of itself and its components; to be called before the done itself is written down."""
        for index, sequence in wishes.get("missed", ()):
            self._records.event(tick_event_t.MISSED, done.host, sequence, index)
        for name, by_channel in wishes.get(MISSED_FRAMES, {}).items():
            for channel, numbers in by_channel.items():
                for number in numbers:
                    self._records.event(
                        tick_event_t.FRAME_MISSED, self._components[name], number, self._channels[channel]
                    )
