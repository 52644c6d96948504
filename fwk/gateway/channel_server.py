"""Answers tools that list channels, show their newest messages and watch them."""

import contextlib
import socket
from collections.abc import Callable, Mapping
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.control import requests
from fwk.control.requests import RequestError
from fwk.control.server import Connection, Server
from fwk.lcm import envelope, messages
from fwk.lcm.messages import Header, MessageError
from fwk.model.channel_table import ChannelState, ChannelTable
from fwk.model.errors import hint
from fwk.model.plan import NOBODY, ChannelPlan, Plan

_BYTES_SHOWN = 64


class ChannelServer:
    """A sink of the gateway with the gateway's control socket.

    Args:
        plan: the plan of the run.
        channels: the channels that exist, including the dynamic ones.
        call: takes requests for components.
        listener: the gateway's control socket.
    """

    def __init__(
        self,
        plan: Plan,
        channels: ChannelTable,
        call: Callable[[requests.CallService, Connection], None],
        listener: socket.socket,
    ) -> None:
        self._plan = plan
        self._table = channels
        self._call = call
        self._channels = {channel.name: channel for channel in plan.channels}
        self._newest: dict[str, bytes] = {}
        self._arrived_us: dict[str, int] = {}
        self._counts = dict.fromkeys(self._channels, 0)
        self._watching: dict[str, list[Connection]] = {}
        self._server = Server(listener, self._take)

    def fileno(self) -> int:
        """Returns the descriptor that is readable when `handle` has something to do."""
        return self._server.fileno()

    def handle(self) -> None:
        """Answers the requests that have arrived."""
        self._server.handle()

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message of the run."""
        if not self._table.find(channel):
            return
        self._newest[channel], self._arrived_us[channel] = data, monotonic_us()
        self._counts[channel] = self._counts.get(channel, 0) + 1
        if channel in self._watching:
            watching = [connection for connection in self._watching[channel] if connection.open]
            self._watching[channel] = watching
            for connection in watching:
                with contextlib.suppress(RequestError):  # it does not decode; its readers complain
                    connection.stream({"ok": True, **self._shown(channel)})

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Disconnects all tools."""
        self._server.close()

    def _take(self, line: bytes, connection: Connection) -> None:
        try:
            request = requests.parsed(requests.to_gateway, line)
            if isinstance(request, requests.Channels):
                connection.reply({"ok": True, "channels": [self._row(each) for each in self._all()]})
                return
            if isinstance(request, requests.CallService):
                self._call(request, connection)
                return
            if isinstance(request, requests.Newest):
                connection.reply({"ok": True, "messages": self._newer_than(request.known)})
                return
            answer = self._shown(request.channel)
            if isinstance(request, requests.Watch):
                self._watching.setdefault(request.channel, []).append(connection)
            connection.reply({"ok": True, **answer})
        except RequestError as error:
            connection.refuse(str(error))
        except Exception as error:  # a defect here must not end the recording
            connection.refuse(f"the gateway cannot answer this: {type(error).__name__}: {error}")

    def _known(self, name: str) -> ChannelPlan:
        """Returns the channel of that name, of the plan or dynamic."""
        state = self._table.find(name)
        if state is None:
            raise RequestError(f"no channel '{name}'; {hint(name, [each.name for each in self._all()])}")
        return self._channels[name] if state.declared else self._opened(state)

    def _all(self) -> list[ChannelPlan]:
        """Returns the plan's channels, then the dynamic ones."""
        opened = [state for state in self._table.matching("*") if not state.declared]
        return [*self._plan.channels, *map(self._opened, opened)]

    def _opened(self, state: ChannelState) -> ChannelPlan:
        writer = state.writer[0] if state.writer else NOBODY
        return ChannelPlan(state.index, state.name, state.type_name, writer, ())

    def _row(self, channel: ChannelPlan) -> dict[str, Any]:
        data = self._newest.get(channel.name)
        header = Header.of(data) if data else None
        plain_type = envelope.is_plain(channel.type_name)
        return {
            "channel": channel.name,
            "type": channel.type_name,
            "writer": self._plan.writer_of(channel),
            "outside": channel.name in self._plan.outside,
            "readers": [self._plan.components[index].name for index in self._readers(channel)],
            "opened": channel.name not in self._channels,
            "messages": self._counts.get(channel.name, 0),
            "sequence": header.sequence if header else 0,
            "tick": header.tick if header else 0,
            "time_us": header.time_us if header else 0,
            "age_s": (monotonic_us() - self._arrived_us[channel.name]) / US_PER_S if data else None,
            "by": header.writer if header else "",
            "plain": plain_type,
            "bytes": 0 if not data or not header else len(data) - header.end * plain_type,
        }

    def _readers(self, channel: ChannelPlan) -> list[int]:
        """Returns the readers of the plan, then those that opened the channel during the run."""
        state = self._table.find(channel.name)
        opened = sorted({component for component, _ in state.readers}) if state else []
        return list(dict.fromkeys([*channel.readers, *opened]))

    def _newer_than(self, known: Mapping[str, int]) -> dict[str, str]:
        """Returns the newest messages, in hexadecimal digits, of the channels that have one with a higher number."""
        return {
            name: data.hex()
            for name, sequence in known.items()
            if (data := self._newest.get(name)) and messages.sequence_of(data) > sequence
        }

    def _shown(self, name: str) -> dict[str, Any]:
        row, data = self._row(self._known(name)), self._newest.get(name)
        if data is None:
            return {**row, "value": None}
        try:
            value = plain(envelope.decode(messages.type_named(row["type"]), data, name))
        except MessageError as error:
            raise RequestError(str(error)) from error
        return {**row, "value": value}


def plain(value: Any) -> Any:
    """Returns a message as plain data for JSON; long byte arrays are replaced by their length."""
    if hasattr(value, "__typenames__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return list(value) if len(value) <= _BYTES_SHOWN else f"{len(value)} bytes"
    return value
