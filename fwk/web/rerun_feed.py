"""Feeds Rerun with a run or a recording: its messages, its images, and the drawings of the views of projects."""

import json
import os
from collections.abc import Callable, Iterable, Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any, Protocol

import rerun as rr

from fwk.clock import US_PER_S
from fwk.lcm.envelope import STAMP
from fwk.lcm.log_file import LogError
from fwk.lcm.messages import current_name, type_name
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import decoded
from fwk.log_tools.live_frames import LiveFrames
from fwk.log_tools.rerun_stream import RerunStream
from fwk.model.errors import hint
from fwk.recording.ticks import tick_of
from fwk.recording.versions import RECORD
from fwk.web.extensions import ExtensionError, Extensions
from fwk.web.scene import Newest, Scene

_EVENTS_PER_CALL = 1000
_FRAME_PERIOD_US = US_PER_S // 5
_LARGE_BATCHES: dict[str, Any] = {"flush_tick": 10.0, "flush_num_bytes": 4 << 20, "flush_num_rows": 4096}
"""For recordings: files are a quarter as large as with the batches of live runs."""
_FLUSH_PERIOD_US = US_PER_S
_FRAMEWORK = "fwk/"
_LOG = "fwk/log"
_SHOWN = (_LOG, "fwk/frame")
"""Channels of the framework that are shown."""

ViewError = ExtensionError


class Message(Protocol):
    """A message with its channel and time."""

    @property
    def channel(self) -> str:
        """Name of the channel."""

    @property
    def data(self) -> bytes:
        """Encoded message, in its envelope if its type has no header."""

    @property
    def time_us(self) -> int:
        """Logical time in us; wall time in logs of lcm-logger."""


class RerunFeed:
    """One stream of Rerun.

    Args:
        name: name of the run.
        channels: patterns of the channels that are shown; none: all.
        modules: further modules with views of projects.
        folder: folder in which these modules are.
        pid: process of a live run with its images; 0: none.

    Raises:
        ExtensionError: a module with views cannot be used.
    """

    def __init__(self, name: str, channels: Sequence[str], modules: Sequence[str], folder: Path, pid: int = 0) -> None:
        batches = rr.ChunkBatcherConfig.DEFAULT() if pid else rr.ChunkBatcherConfig(**_LARGE_BATCHES)
        self._recording = rr.RecordingStream("fwk", recording_id=name, batcher_config=batches)
        self._recording.send_recording_name(name)
        self._recording.set_log_time_enabled(False)
        self._recording.set_log_tick_enabled(False)
        self._is_file = False
        self._extensions = Extensions(modules, folder)
        self._patterns = channels
        self._shown: dict[str, bool] = {}
        self._frames = LiveFrames(pid) if pid else None
        self._frame_due_us: dict[str, int] = {}
        self._newest: dict[str, Any] = {}
        self._seen = 0
        self._views: list[Any] = []
        self._tick = self._time_us = self._zero_us = self._flushed_us = 0
        self._stream: RerunStream | None = None
        self.undecodable: dict[str, int] = {}
        """Channels with messages that are not shown, because their type is unknown or they do not decode."""

    def save(self, file: Path) -> None:
        """Writes to a file from now on."""
        self._is_file = True
        self._recording.save(file)

    def spawn(self, port: int) -> None:
        """Opens the viewer on the screen of this machine."""
        self._recording.spawn(port=port)

    def serve(self, port: int) -> str:
        """Serves the viewer as a web page on the port after that of the stream; returns the address."""
        stream = self._recording.serve_grpc(grpc_port=port)
        has_screen = bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
        rr.serve_web_viewer(web_port=port + 1, open_browser=has_screen, connect_to=stream)
        return f"http://127.0.0.1:{port + 1}/?url={stream}"

    def read(self, log: Path, progress: Callable[[int], None] = lambda _: None) -> None:
        """Shows a recording, or a log of lcm-logger.

        Raises:
            LogError: the log cannot be read, or a pattern of channels matches none in it.
        """
        reader = StampedLog(log)
        for number, event in enumerate(reader):
            if not number % _EVENTS_PER_CALL:
                progress(reader.position)
            if not number and event.channel != "fwk/plan":
                self._zero_us = event.time_us
            self._take(event)
        for pattern in self._patterns:
            if not any(fnmatchcase(channel, pattern) for channel in self._shown):
                raise LogError(f"{log}: no channel matches '{pattern}'; {hint(pattern, sorted(self._shown))}")

    def follow(self, messages: Iterable[Message]) -> None:
        """Shows the messages of a live run."""
        for message in messages:
            self._take(message)
            if self._time_us - self._flushed_us >= _FLUSH_PERIOD_US:
                self._flushed_us = self._time_us
                self._output.flush()

    def close(self) -> None:
        """Sends all waiting data; completes a file."""
        self._draw()
        self._output.flush()
        if self._is_file:
            self._recording.disconnect()  # completes the file

    @property
    def _output(self) -> RerunStream:
        if self._stream is None:  # after the sink is known
            self._stream = RerunStream(self._recording)
        return self._stream

    def _take(self, message: Message) -> None:
        channel, data = message.channel, message.data
        if channel == STAMP or not self._is_shown(channel):
            return
        tick = tick_of(channel, data)
        time_us = message.time_us - self._zero_us
        if channel == _LOG:
            self._take_line(data, tick or self._tick, time_us)
            return
        if tick is not None and tick > self._tick:
            self._draw()
            self._tick, self._time_us = tick, max(self._time_us, time_us)
            self._output.at(self._tick, self._time_us)
        elif tick is None and time_us > self._time_us and not channel.startswith(_FRAMEWORK):
            self._time_us = time_us
            self._output.at(self._tick, time_us)
        if channel == RECORD:
            return
        try:
            found = decoded(data)
        except Exception:  # unknown type, or any error of generated code on broken bytes
            self.undecodable[channel] = self.undecodable.get(channel, 0) + 1
            return
        self._newest[channel] = found
        self._output.show(channel, found)
        if self._frames and current_name(type_name(type(found))) == "core.frame_t":
            self._look(channel, found)

    def _take_line(self, data: bytes, tick: int, time_us: int) -> None:
        """Shows a log line at its own tick: lines may come before the messages of earlier ticks."""
        try:
            line = decoded(data)
        except Exception:  # any error of generated code on broken bytes
            self.undecodable[_LOG] = self.undecodable.get(_LOG, 0) + 1
            return
        self._output.at(tick, time_us if self._zero_us else line.time_us)
        self._output.show(_LOG, line)
        self._output.at(self._tick, self._time_us)

    def _is_shown(self, channel: str) -> bool:
        shown = self._shown.get(channel)
        if shown is None:
            if channel.startswith(_FRAMEWORK):
                shown = channel in (*_SHOWN, RECORD)
            else:
                shown = not self._patterns or any(fnmatchcase(channel, each) for each in self._patterns)
            self._shown[channel] = shown
        return shown

    def _look(self, camera: str, announced: Any) -> None:
        """Shows an image of a live run, at most five a second of each camera."""
        if self._frames and self._time_us >= self._frame_due_us.get(camera, 0):
            self._frame_due_us[camera] = self._time_us + _FRAME_PERIOD_US
            pixels = self._frames.pixels(camera, announced)
            if pixels is not None:
                self._output.frame(camera, pixels)

    def _draw(self) -> None:
        """Draws the newest messages with the views of projects."""
        if len(self._newest) != self._seen:
            self._seen = len(self._newest)
            self._views = self._extensions.views_for(self._newest)
        newest = Newest(self._newest)
        for view in self._views:
            if view.channels:
                scene = Scene()
                view.draw(newest, scene)
                self._output.draw(view.title, json.loads(scene.encoded()))
            for camera in self._frame_due_us if view.sees else ():
                scene = Scene()
                view.sight(camera, newest, scene)
                self._output.draw_over(camera, view.title, json.loads(scene.encoded()))
