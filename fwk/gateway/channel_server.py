"""The blackboard from outside: channels' newest messages for whoever asks, each new one for whoever watches."""

import contextlib
from collections.abc import Callable
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.control import requests
from fwk.control.address import gateway_address
from fwk.control.requests import RequestError
from fwk.control.server import Connection, Server
from fwk.lcm import envelope, messages
from fwk.lcm.messages import Header, MessageError
from fwk.model.channel_table import ChannelTable, Instance
from fwk.model.errors import hint
from fwk.model.plan import NOBODY, ChannelPlan, Plan

_BYTES_SHOWN = 64


class ChannelServer:
    """A sink of the gateway that answers questions."""

    def __init__(self, plan: Plan, instances: ChannelTable, call: Callable[[requests.Call, Connection], None]) -> None:
        self._plan = plan
        self._instances = instances
        self._call = call
        self._channels = {channel.name: channel for channel in plan.channels}
        self._newest: dict[str, bytes] = {}
        self._arrived_us: dict[str, int] = {}
        self._counts = dict.fromkeys(self._channels, 0)
        self._watching: dict[str, list[Connection]] = {}
        self._server = Server(gateway_address(plan.bus_port), self._take)

    def fileno(self) -> int:
        """For waiting until somebody asks."""
        return self._server.fileno()

    def handle(self) -> None:
        """Answers who asks."""
        self._server.handle()

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message."""
        if not self._instances.find(channel):
            return
        self._newest[channel], self._arrived_us[channel] = data, monotonic_us()
        self._counts[channel] = self._counts.get(channel, 0) + 1
        if channel in self._watching:
            watching = [connection for connection in self._watching[channel] if connection.open]
            self._watching[channel] = watching
            for connection in watching:
                with contextlib.suppress(RequestError):  # one that does not decode; its reader complains
                    connection.stream({"ok": True, **self._shown(channel)})

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """The run is over."""
        self._server.close()

    def _take(self, line: bytes, connection: Connection) -> None:
        try:
            request = requests.parsed(requests.to_gateway, line)
            if isinstance(request, requests.Channels):
                connection.reply({"ok": True, "channels": [self._row(each) for each in self._all()]})
                return
            if isinstance(request, requests.Call):
                self._call(request, connection)
                return
            answer = self._shown(request.channel)
            if isinstance(request, requests.Watch):
                self._watching.setdefault(request.channel, []).append(connection)
            connection.reply({"ok": True, **answer})
        except RequestError as error:
            connection.refuse(str(error))
        except Exception as error:  # a mistake in here must not end the recording
            connection.refuse(f"the gateway cannot answer this: {type(error).__name__}: {error}")

    def _known(self, name: str) -> ChannelPlan:
        """The channel of that name, of the plan or opened while the run goes on."""
        instance = self._instances.find(name)
        if instance is None:
            raise RequestError(f"no channel '{name}'; {hint(name, [each.name for each in self._all()])}")
        return self._channels[name] if instance.declared else self._opened(instance)

    def _all(self) -> list[ChannelPlan]:
        """The plan's channels, and after them those that were opened while the run goes on."""
        opened = [instance for instance in self._instances.matching("*") if not instance.declared]
        return [*self._plan.channels, *map(self._opened, opened)]

    def _opened(self, instance: Instance) -> ChannelPlan:
        writer = instance.writer[0] if instance.writer else NOBODY
        return ChannelPlan(instance.index, instance.name, instance.type_name, writer, ())

    def _row(self, channel: ChannelPlan) -> dict[str, Any]:
        names = [component.name for component in self._plan.components]
        data = self._newest.get(channel.name)
        header = Header.of(data) if data else None
        plain_type = envelope.is_plain(channel.type_name)
        return {
            "channel": channel.name,
            "type": channel.type_name,
            "writer": self._plan.writer_of(channel),
            "outside": channel.name in self._plan.outside,
            "readers": [names[index] for index in self._readers(channel)],
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
        """Those of the plan, then those who opened it at run time."""
        instance = self._instances.find(channel.name)
        opened = sorted({component for component, _ in instance.readers}) if instance else []
        return list(dict.fromkeys([*channel.readers, *opened]))

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
    """A message as plain data for JSON; of long byte arrays only how long they are."""
    if hasattr(value, "__typenames__"):
        return {name: plain(getattr(value, name)) for name in value.__slots__}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return list(value) if len(value) <= _BYTES_SHOWN else f"{len(value)} bytes"
    return value
