"""Serves messages to Foxglove while they come: every message as JSON with the schema of its type, and its views."""

import json
from typing import Any

import numpy as np
from foxglove import Channel, Context, Schema, start_server

from fwk.lcm.messages import current_name, type_name
from fwk.lcm.type_registry import decoded, types_of
from fwk.log_tools.live_frames import LiveFrames
from fwk.log_tools.plain import json_schema, plain
from fwk.log_tools.views import PREFIX, View, frame_view, views_of

_NS_PER_US = 1000
_COLOURS = 3
_NO_PIXELS = np.zeros((1, 1), np.uint8)


class FoxgloveServer:
    """A WebSocket server on the loopback interface to which Foxglove connects.

    Args:
        name: shown by Foxglove.
        port: 0 chooses a free one.
        frames: the frames of the run's cameras.

    Raises:
        RuntimeError, OSError: the port is taken.
    """

    def __init__(self, name: str, port: int, frames: LiveFrames | None = None) -> None:
        self._frames = frames
        self._context = Context()
        self._server = start_server(name=name, host="127.0.0.1", port=port, context=self._context)
        self._channels: dict[str, Channel] = {}
        self.undecodable: dict[str, int] = {}
        """Channels with messages that were left out, because their type is unknown or they do not decode; with
        numbers.
        """

    @property
    def port(self) -> int:
        """The port that it listens on."""
        return int(self._server.port)

    def show(self, channel: str, data: bytes, time_us: int) -> None:
        """Sends a message and its views to the clients that have subscribed to them; `time_us` is logical."""
        try:
            message = decoded(data)
        except Exception:  # unknown type, or any error of generated code on broken bytes
            self.undecodable[channel] = self.undecodable.get(channel, 0) + 1
            return
        time_ns = max(0, time_us) * _NS_PER_US
        topic = self._channels.get(channel)
        if topic is None:
            kind = types_of(data)[0]
            schema = Schema(name=type_name(kind), encoding="jsonschema", data=json.dumps(json_schema(kind)).encode())
            topic = self._channel(channel, schema, "json")
        if topic.has_sinks():
            topic.log(json.dumps(plain(message)).encode(), log_time=time_ns)
        for view in views_of(channel, message, max(0, time_us)):
            topic = self._view_channel(view)
            if topic.has_sinks():
                topic.log(view.content.encode(), log_time=time_ns)
        if self._frames and current_name(type_name(type(message))) == "core.frame_t":
            self._show_frame(channel, message, time_us)

    def close(self) -> None:
        """Ends all connections."""
        self._server.stop()

    def _show_frame(self, camera: str, announced: Any, time_us: int) -> None:
        """Sends a frame from shared memory, if a client has subscribed to it."""
        topic = self._channels.get(PREFIX + camera) or self._view_channel(frame_view(camera, _NO_PIXELS, 0))
        if self._frames and topic.has_sinks():
            pixels = self._frames.pixels(camera, announced)
            if pixels is not None and (pixels.ndim == 2 or pixels.shape[2] == _COLOURS):
                topic.log(frame_view(camera, pixels, time_us).content.encode(), log_time=time_us * _NS_PER_US)

    def _view_channel(self, view: View) -> Channel:
        schema = view.content.get_schema()
        return self._channels.get(view.topic) or self._channel(view.topic, schema, schema.encoding)

    def _channel(self, topic: str, schema: Schema, encoding: str) -> Channel:
        made = Channel(topic, schema=schema, message_encoding=encoding, context=self._context)
        self._channels[topic] = made
        return made
