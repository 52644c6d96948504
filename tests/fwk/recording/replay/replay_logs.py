"""Builds recordings directly, tick by tick."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fwk.lcm.event_log import LogWriter
from fwk.lcm.messages import encode
from fwk.model.plain_values import value_messages
from fwk.model.plan import Plan
from fwk.model.plan_document import document_of
from fwk.model.tick_events import TickEvent, events_message
from fwk.recording.replay.recording import Recording
from fwk.recording.replay.replay import Replay
from lcmtypes.core import channels_change_t, plan_t, protocol_t, settings_change_t, tick_record_t

PERIOD_US = 50_000


class HandMadeLog:
    """A recording of a plan."""

    def __init__(self, path: Path, plan: Plan) -> None:
        self.path = path
        self._indices = {channel.name: channel.index for channel in plan.channels}
        self._newest: dict[str, int] = {}
        self._log = LogWriter(path, print)
        said = plan_t()
        said.version = protocol_t.VERSION
        said.json = json.dumps(document_of(plan))
        self._log.append("fwk/plan", said.encode(), 0)

    def message(self, channel: str, message: Any, writer: str, tick: int, step: int) -> None:
        """Records the next message of a channel, written in a step of a tick."""
        header = message.header
        header.tick, header.stage, header.time_us, header.writer = tick, step, tick * PERIOD_US, writer
        header.sequence = self._newest[channel] = self._newest.get(channel, 0) + 1
        self._log.append(channel, message.encode(), 0)

    def tick(
        self,
        tick: int,
        events: Sequence[TickEvent],
        changes: Sequence[channels_change_t] = (),
        settings: Mapping[int, Mapping[str, Any]] | None = None,
    ) -> None:
        """Records the end of a tick, which began with new settings of components."""
        made = tick_record_t()
        made.version, made.tick, made.time_us = protocol_t.VERSION, tick, tick * PERIOD_US
        made.events = events_message(events)
        made.channel = [self._indices[channel] for channel in self._newest]
        made.sequence = list(self._newest.values())
        made.n_marks = len(made.channel)
        made.channels, made.n_channels = list(changes), len(changes)
        for component, values in (settings or {}).items():
            change = settings_change_t()
            change.component, change.number, change.values = component, tick, value_messages(dict(values))
            made.settings.append(change)
        self._log.append("fwk/record", encode(made, "fwk/record"), made.time_us)

    def replayed(self) -> Replay:
        """Returns the replay of the recording, at its end."""
        self._log.close()
        made = Replay(Recording(self.path))
        made.run()
        return made
