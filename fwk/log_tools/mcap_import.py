"""Imports MCAP files: messages of LCM types, as JSON or as the bytes of LCM, become an LCM log."""

import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from mcap.exceptions import McapError
from mcap.reader import make_reader
from mcap.records import Channel, Message, Schema

from fwk.lcm.event_log import LogError
from fwk.lcm.messages import MessageError, encode, type_named
from fwk.log_tools.mcap_export import RAW, VIEW_OF
from fwk.log_tools.new_file import new_log
from fwk.log_tools.plain import of_plain

_NS_PER_US = 1000
_WRONG = (MessageError, TypeError, ValueError, LookupError, AttributeError)


class McapImport:
    """Import of an MCAP file with its figures."""

    def __init__(self, path: Path) -> None:
        self.events = 0
        """Events in the new log."""
        self.left_out: dict[str, str] = {}
        """Topics that are not in the log, with the reasons."""
        self._path = path

    def write(self, out: Path, replace: bool = False) -> None:
        """Writes the messages to a new log, in the order of the file's times.

        Raises:
            LogError: the file cannot be read, holds no message of an LCM type, or the log cannot be written.
        """
        with new_log(out, replace) as log:
            for schema, channel, message in self._messages():
                if VIEW_OF in channel.metadata:
                    continue
                data = self._data(schema, channel, message)
                if data is not None:
                    log.append(channel.topic, data, message.log_time // _NS_PER_US)
            self.events = log.events
            if not self.events and self.left_out:
                topic, reason = next(iter(self.left_out.items()))
                raise LogError(f"{self._path}: nothing to import: {topic}: {reason}")

    def _messages(self) -> Iterator[tuple[Schema | None, Channel, Message]]:
        try:
            with open(self._path, "rb") as file:
                yield from make_reader(file).iter_messages()
        except (McapError, OSError, struct.error) as error:
            raise LogError(f"{self._path}: cannot be read as MCAP: {error}") from error

    def _data(self, schema: Schema | None, channel: Channel, message: Message) -> bytes | None:
        """Returns the bytes of LCM; None: the message has no LCM type."""
        if channel.message_encoding == RAW:
            return message.data
        name = schema.name if schema else ""
        if channel.message_encoding != "json":
            self.left_out[channel.topic] = f"its encoding is {channel.message_encoding}, not json or {RAW}"
            return None
        try:
            kind: Any = type_named(name)
            return encode(of_plain(kind, json.loads(message.data)), channel.topic)
        except _WRONG as error:
            self.left_out.setdefault(channel.topic, str(error))
            return None
