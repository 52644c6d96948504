"""Exports a log to MCAP, which Foxglove opens: every message as JSON with the schema of its type, and its views."""

import json
from pathlib import Path
from typing import Any

from mcap.writer import Writer

from fwk.lcm.event_log import Event, LogReader
from fwk.lcm.messages import sequence_of, type_name
from fwk.lcm.type_registry import MessageType, decoded, is_interface, types_of
from fwk.log_tools.cut import EVENTS_PER_CALL, Progress, paired
from fwk.log_tools.plain import json_schema, plain
from fwk.log_tools.selection import Selection
from fwk.log_tools.views import View, views_of

LIBRARY = "fwk"
RAW = "lcm"
"""Encoding of messages of no known type, or that do not decode: the bytes of the log."""
VIEW_OF = "view_of"
"""Metadata of a topic with views: the channel."""
_NS_PER_US = 1000
_SEQUENCE_MAX = 0xFFFFFFFF


class McapExport:
    """Writes the messages of a log to an MCAP file."""

    def __init__(self, out: Path) -> None:
        self.messages = 0
        """Messages of the log in the file."""
        self.views = 0
        """Further messages, of Foxglove's well-known types."""
        self.undecodable: dict[str, int] = {}
        """Channels with messages that are in the file as raw bytes, with their numbers."""
        self.damaged_bytes = 0
        self._file = open(out, "wb")  # noqa: SIM115 - closed by close()
        self._writer = Writer(self._file)
        self._writer.start(library=LIBRARY)
        self._channels: dict[tuple[str, str], int] = {}
        self._schemas: dict[str, int] = {}

    def write(self, log: Path, selection: Selection, progress: Progress = lambda _: None) -> None:
        """Writes all selected messages of a log.

        Raises:
            LogError: the log cannot be read, or a pattern of the selection matches nothing.
        """
        reader = LogReader(log)
        for number, (stamp, event) in enumerate(paired(iter(reader))):
            if not number % EVENTS_PER_CALL:
                progress(reader.position)
            if not selection.takes(event):
                continue
            if stamp and selection.takes_stamps:
                self._add(stamp)
            self._add(event)
        reader.check_any()
        self.damaged_bytes = reader.skipped_bytes
        selection.check(str(log))

    def close(self) -> None:
        """Completes the file."""
        self._writer.finish()  # type: ignore[no-untyped-call]
        self._file.close()

    def _add(self, event: Event) -> None:
        self.messages += 1
        try:
            message = decoded(event.data)
        except Exception:  # unknown type, or any error of generated code on broken bytes
            self.undecodable[event.channel] = self.undecodable.get(event.channel, 0) + 1
            self._put(event, self._channel(event.channel, RAW, 0), event.data)
            return
        kind = types_of(event.data)[0]
        schema = self._schema_of(kind)
        channel = self._channel(event.channel, "json", schema, type=type_name(kind), fingerprint=event.data[:8].hex())
        self._put(event, channel, json.dumps(plain(message)).encode())
        for view in views_of(event.channel, message, max(0, event.time_us)):
            self._view(event, view)

    def _view(self, event: Event, view: View) -> None:
        self.views += 1
        schema = view.content.get_schema()
        if schema.name not in self._schemas:
            self._schemas[schema.name] = self._writer.register_schema(schema.name, schema.encoding, schema.data)
        channel = self._channel(view.topic, schema.encoding, self._schemas[schema.name], **{VIEW_OF: event.channel})
        self._put(event, channel, view.content.encode())

    def _put(self, event: Event, channel: int, data: bytes) -> None:
        time_ns = max(0, event.time_us) * _NS_PER_US
        sequence = sequence_of(event.data) if len(event.data) >= 24 and is_interface(event.data) else event.number
        self._writer.add_message(channel, time_ns, data, time_ns, sequence & _SEQUENCE_MAX)

    def _schema_of(self, kind: MessageType) -> int:
        name = type_name(kind)
        if name not in self._schemas:
            text = json.dumps(json_schema(kind)).encode()
            self._schemas[name] = self._writer.register_schema(name, "jsonschema", text)
        return self._schemas[name]

    def _channel(self, topic: str, encoding: str, schema: int, **metadata: str) -> int:
        key = topic, f"{encoding} {schema}"
        if key not in self._channels:
            about: dict[str, Any] = metadata
            self._channels[key] = self._writer.register_channel(topic, encoding, schema, about)
        return self._channels[key]
