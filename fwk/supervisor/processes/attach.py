"""Gives the places of hosts to external processes."""

import dataclasses
import os
import socket
from collections.abc import Mapping

from fwk.component.images import Ring
from fwk.control.requests import RequestError
from fwk.control.server import Connection
from fwk.engine.assignment import Start
from fwk.supervisor.core import Core
from fwk.supervisor.processes.external_process import ExternalProcess
from fwk.supervisor.processes.hosts import Hosts


class Attach:
    """Lets external processes take the places of hosts, and sends them what they need to know."""

    def __init__(
        self, core: Core, hosts: Hosts, rings: Mapping[str, Ring], sockets: Mapping[int, socket.socket]
    ) -> None:
        self._core = core
        self._hosts = hosts
        self._rings = rings
        self._sockets = sockets

    def give(self, host: int, connection: Connection, held: bool) -> None:
        """Gives a host's place to the process at the other end at the next boundary, and answers it then.

        Raises:
            RequestError: the process cannot have the place; the text gives the reason.
        """
        entry = self._core.hosts[host]
        other = self._hosts.external_process(entry)
        if other:
            raise RequestError(f"{entry.name} is run by process {other}; end that first")
        try:
            process = ExternalProcess(
                connection.pid, held, lambda start: self._begin(host, connection, start), self._core.events
            )
        except OSError as error:
            raise RequestError(f"the requesting process cannot be seen from here: {error.strerror}") from error
        self._hosts.hand_over(entry, process)

    def _begin(self, host: int, connection: Connection, start: Start) -> None:
        told = {
            "run": self._core.run,
            "start": dataclasses.asdict(start),
            "rings": self._rings_of(host),
        }
        held = self._sockets.get(self._core.ports.host(host))
        connection.reply({"ok": True, **told}, [held.fileno()] if held else [])

    def _rings_of(self, host: int) -> dict[str, str]:
        """Returns the files, for this user and root alone, of the frames that components of the host read or write."""
        members = set(self._core.plan.hosts[host].components)
        return {
            channel.name: f"/proc/{os.getpid()}/fd/{self._rings[channel.name].descriptor}"
            for channel in self._core.plan.channels
            if channel.images and members & {channel.writer, *channel.readers}
        }
