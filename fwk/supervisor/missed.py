"""Frames that readers did not get, on their way from a done into the record of the tick."""

import json

from fwk.plan.model import Plan
from fwk.runner import MISSED_FRAMES
from fwk.supervisor.records import Records
from lcmtypes.core import done_t, tick_event_t


class Missed:
    """Writes them down, so that a replay keeps the same frames from the same readers."""

    def __init__(self, plan: Plan, records: Records) -> None:
        self._components = {component.name: component.index for component in plan.components}
        self._channels = {channel.name: channel.index for channel in plan.channels if channel.images}
        self._records = records

    def take(self, done: done_t) -> None:
        """What a host says of its components; to be called before the done itself is written down."""
        for name, by_channel in json.loads(done.wishes).get(MISSED_FRAMES, {}).items():
            for channel, numbers in by_channel.items():
                for number in numbers:
                    self._records.event(
                        tick_event_t.FRAME_MISSED, self._components[name], number, self._channels[channel]
                    )
