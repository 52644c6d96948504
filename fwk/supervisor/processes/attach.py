"""Gives the places of hosts to processes that somebody started by hand."""

import dataclasses
import os
from collections.abc import Mapping

from fwk.component.images import Ring
from fwk.control.requests import RequestError
from fwk.control.server import Connection
from fwk.engine.assignment import Start
from fwk.model.plan import Plan
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.processes.external_process import Hand
from fwk.supervisor.processes.hosts import Hosts


class Places:
    """Knows what such a process has to be told, and whether it can have the place."""

    def __init__(self, plan: Plan, run: int, hosts: Hosts, events: EventLoop, rings: Mapping[str, Ring]) -> None:
        self._plan = plan
        self._run = run
        self._hosts = hosts
        self._events = events
        self._rings = rings

    def give(self, host: int, connection: Connection, held: bool) -> None:
        """The process at the other end takes the host's place at the next boundary, and is answered then.

        Raises:
            RequestError: it cannot.
        """
        entry = self._hosts.table[host]
        other = self._hosts.by_hand(entry)
        if other:
            raise RequestError(f"{entry.name} is in the hands of process {other}; end that first")
        try:
            hand = Hand(connection.pid, held, lambda start: self._begin(host, connection, start), self._events)
        except OSError as error:
            raise RequestError(f"the process that asks cannot be seen from here: {error.strerror}") from error
        self._hosts.hand_over(entry, hand)

    def _begin(self, host: int, connection: Connection, start: Start) -> None:
        told = {
            "run": self._run,
            "start": dataclasses.asdict(start),
            "rings": self._rings_of(host),
        }
        connection.reply({"ok": True, **told})

    def _rings_of(self, host: int) -> dict[str, str]:
        """Where the frames lie that components of the host read or write: files for this user and root alone."""
        members = set(self._plan.hosts[host].components)
        return {
            channel.name: f"/proc/{os.getpid()}/fd/{self._rings[channel.name].descriptor}"
            for channel in self._plan.channels
            if channel.images and members & {channel.writer, *channel.readers}
        }
