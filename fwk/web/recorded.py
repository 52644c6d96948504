"""Recordings as pages show them: the newest messages at any tick of a log."""

import threading
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

from fwk.lcm.event_log import LogReader
from fwk.lcm.type_registry import decoded
from fwk.model.plan import Plan
from fwk.recording.log_contents import LogInfo
from fwk.recording.pictures import RecordedPicture, picture_of
from fwk.recording.versions import BROKEN, read_plan
from fwk.web.recorded_ticks import RecordedTicks, contents

LOG = "log.lcm"
_BEGIN_TICKS = 20
"""Channels that are written only at the beginning, such as the measures of a field; known at every tick."""
_DECODED_MAX = 8
_BACK_TICKS = 100
"""After a jump, a channel without a message in so many ticks has no value."""


class _Seen(NamedTuple):
    """Newest messages and images after a tick."""

    messages: dict[str, Any]
    """By channel."""
    pictures: dict[str, bytes]
    """Messages with the images of cameras, by the channel of the camera's frames."""


class RecordedRun:
    """One recording; its run may go on. Reading on to a later tick is quick; a jump reads the hundred ticks before it.

    Raises:
        LogError: the log cannot be read.
    """

    def __init__(self, folder: Path) -> None:
        self.path = folder / LOG
        self.info: LogInfo = contents(self.path)
        self._ticks = RecordedTicks(self.path)
        self._reader = LogReader(self.path)
        self.plan: Plan | None = self._read_plan()
        """Plan of the recorded run; None: the log has none that can be read."""
        self._lock = threading.Lock()
        self._tick = 0
        self._newest = _Seen({}, {})
        """Its messages are encoded."""
        self._decoded: dict[int, _Seen] = {}
        self._begin = self._read(_Seen({}, {}), 0, _BEGIN_TICKS).messages

    @property
    def last_tick(self) -> int:
        """The last tick of the recording; 0 if it has none."""
        return self.info.ticks[1] if self.info.ticks else 0

    def newest(self, tick: int) -> dict[str, Any]:
        """Returns the newest messages after a tick, decoded, by channel; those of unknown types are left out."""
        return self._seen(tick).messages

    def picture(self, camera: str, tick: int) -> RecordedPicture | None:
        """Returns the newest image of a camera after a tick; None: its images were not recorded."""
        data = self._seen(tick).pictures.get(camera)
        return picture_of(data) if data else None

    def _seen(self, tick: int) -> _Seen:
        if known := self._decoded.get(tick):
            return known
        with self._lock:
            if not self._tick <= tick <= self._tick + _BACK_TICKS:
                self._newest, self._tick = _Seen(self._begin, {}), max(0, tick - _BACK_TICKS)
            found = self._newest = self._read(self._newest, self._tick, tick)
            self._tick = tick
        made = {}
        for channel, data in found.messages.items():
            try:
                made[channel] = decoded(data)
            except Exception:  # of generated code, or a type that is not known here
                continue
        if len(self._decoded) >= _DECODED_MAX:
            self._decoded = {}
        seen = self._decoded[tick] = _Seen(made, found.pictures)
        return seen

    def time_us(self, tick: int) -> int:
        """Returns the logical time at which a tick begins."""
        with self._lock:
            position = self._ticks.position(tick)
            first = None if position is None else next(self._reader.events_from(position), None)
            return first.time_us if first else self.info.last_us

    def _read_plan(self) -> Plan | None:
        with suppress(*BROKEN):
            return read_plan(self._ticks.plan)[0] if self._ticks.plan else None
        return None

    def _read(self, newest: _Seen, after: int, until: int) -> _Seen:
        """Returns the newest messages and images, with those of the ticks from `after` to `until`."""
        made = _Seen(dict(newest.messages), dict(newest.pictures))
        begin, end = self._ticks.position(after + 1), self._ticks.position(until + 1)
        if begin is None:
            return made
        for event in self._reader.events_from(begin):
            if end is not None and self._reader.position > end:
                break
            if not event.channel.startswith("fwk/"):
                made.messages[event.channel] = event.data
            if picture := picture_of(event.data):
                made.pictures[picture.camera] = event.data
        return made


class RecordedRuns:
    """The recordings that pages look at, by the name of their run directory."""

    def __init__(self) -> None:
        self._open: dict[str, RecordedRun] = {}

    def of(self, folder: str, anew: bool = False) -> RecordedRun:
        """Opens a recording; with `anew` once more if it has grown since.

        Raises:
            LogError: the log cannot be read.
        """
        known = self._open.get(folder)
        if known is None or (anew and LogReader(known.path).size_bytes != known.info.size_bytes):
            if len(self._open) >= 4:
                self._open.pop(next(iter(self._open)))
            self._open[folder] = RecordedRun(Path(folder))
        return self._open[folder]
