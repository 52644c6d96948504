"""Answers what is asked of a running supervisor; what changes the run waits for the next boundary between two ticks."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fwk.clock import US_PER_S
from fwk.component.log import Logger
from fwk.control import requests
from fwk.control.requests import RequestError
from fwk.control.server import Answer, Connection, Server
from fwk.control.settings import NewSettings, RunSettings
from fwk.model.plan import Plan
from fwk.supervisor.control.clock_control import ClockControl
from fwk.supervisor.control.lifecycle import Steering
from fwk.supervisor.control.plugin_requests import Directing
from fwk.supervisor.control.view import component_view, period_us, times_view
from fwk.supervisor.event_loop import EventLoop
from fwk.supervisor.loop import MainLoop
from fwk.supervisor.options import RunOptions
from fwk.supervisor.processes.attach import Places
from fwk.supervisor.processes.host_process import HostEntry
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import status_t

_FRESH_US = 2 * US_PER_S  # rates older than this say nothing


Listen = Callable[[Answer], Server]
"""Opens the control server that hands requests to an answer."""


@dataclass(frozen=True)
class _Waiting:
    """Somebody who is answered when something has happened."""

    connection: Connection
    happened: Callable[[], dict[str, Any] | None]
    """The answer, when it has."""


class Control:
    """The supervisor's ear."""

    def __init__(
        self,
        plan: Plan,
        options: RunOptions,
        hosts: Hosts,
        loop: MainLoop,
        events: EventLoop,
        log: Logger,
        places: Places,
        listen: Listen | None,
    ) -> None:
        self.settings = RunSettings(plan)
        self._plan = plan
        self._options = options
        self._hosts = hosts
        self._loop = loop
        self._log = log
        self._places = places
        self._steering = Steering(plan, hosts.table)
        self._directing = Directing(plan, hosts, self._steering, events.now_us, log)
        loop.on_requests = self._directing.ask
        self._clock = ClockControl(loop, log)
        self._status = status_t()
        self._status_us = 0
        self._new: list[tuple[NewSettings, str]] = []
        self._waiting: list[_Waiting] = []
        self._watching: list[tuple[Connection, list[str]]] = []
        self._events = events
        self._server = listen(self.take) if listen else None
        if self._server:
            events.watch(self._server, self._server.handle)
        events.afterwards = self.check
        hosts.settings_of = self._settings_of
        loop.on_boundary = self._boundary

    def close(self) -> None:
        """Answers nobody any more."""
        self._events.afterwards = lambda: None
        if self._server:
            self._events.unwatch(self._server)
            self._server.close()

    def published(self, status: status_t) -> None:
        """The newest published status; its rates are shown to who asks."""
        self._status, self._status_us = status, self._events.now_us()

    def check(self) -> None:
        """Answers those who wait for something that has happened meanwhile."""
        if not self._waiting:
            return
        still = []
        for waiting in self._waiting:
            answer = waiting.happened()
            if answer is not None:
                waiting.connection.reply({"ok": True, **answer})
            elif waiting.connection.open:
                still.append(waiting)
        self._waiting = still

    def take(self, line: bytes, connection: Connection) -> None:
        """Answers a control request at once, later, or again and again."""
        try:
            request = requests.parsed(requests.to_supervisor, line)
            answer = self._answer(request, connection)
        except RequestError as error:
            connection.refuse(str(error))
            return
        except Exception as error:  # a mistake in here must not end the run
            self._log.error(f"cannot answer {line[:200]!r}: {type(error).__name__}: {error}")
            connection.refuse(f"the run cannot answer this: {type(error).__name__}: {error}")
            return
        if answer is not None:
            connection.reply({"ok": True, **answer})

    def _answer(self, request: requests.SupervisorRequest, connection: Connection) -> dict[str, Any] | None:
        if isinstance(request, requests.Run):
            return self._run()
        if isinstance(request, requests.Status):
            return {**self._run(), **self._now(), "components": self._components(request.names)}
        if isinstance(request, requests.Times):
            return times_view(self._plan, self._loop.times, self._hosts.table)
        if isinstance(request, requests.Steer):
            self._steer(request, connection)
            return None
        if isinstance(request, requests.TakePlace):
            self._take_place(request, connection)
            return None
        if isinstance(request, requests.Clock):
            self._wait(connection, self._clock.ask(request))
            return None
        if isinstance(request, requests.Settings):
            return {"settings": self.settings.rows(request.names)}
        if isinstance(request, requests.SetSettings):
            return self._set(request, connection)
        if isinstance(request, requests.WatchSettings):
            rows = self.settings.rows(request.names)
            self._watching.append((connection, request.names))
            return {"settings": rows}
        if isinstance(request, requests.Note):
            (self._log.warning if request.level == "warning" else self._log.info)(request.text)
            return {"tick": self._loop.tick}
        return self._common(request, connection)

    def _run(self) -> dict[str, Any]:
        record = self._options.record
        return {
            "name": self._options.name or self._plan.name,
            "plan": self._plan.name,
            "file": self._plan.file,
            "folders": list(self._plan.folders),
            "run_dir": str(self._options.run_dir),
            "record": str(record) if record else "",
            "pid": os.getpid(),
            "bus_port": self._plan.bus_port,
            "public_url": self._plan.public_url,
            "seed": self._plan.seed,
            "clock": self._plan.clock,
            "period_us": self._plan.period_us,
            "watching": len(self._watching),
        }

    def _now(self) -> dict[str, Any]:
        fresh = self._events.now_us() < self._status_us + _FRESH_US
        return {
            **self._clock.now(),
            "speed": self._status.speed if fresh else 0.0,
            "ticks_per_s": self._status.ticks_per_s if fresh else 0.0,
            "repeated": self._loop.repeated,
            "late": self._loop.late,
            "waits_for": self._loop.waits_for,
            **self._loop.turns.view,
        }

    def _components(self, names: list[str]) -> list[dict[str, Any]]:
        chosen = self._steering.components(names or ["*"])
        components = [self._plan.components[index] for index in chosen]
        return [component_view(self._plan, each, self._hosts.table[each.host]) for each in components]

    def _steer(self, request: requests.Steer, connection: Connection) -> None:
        entries = self._steering.hosts(request.action, request.names, request.force)
        for entry in entries:
            self._steering.wish(request.action, entry, self._events.now_us())
            self._hosts.asked.add(entry.index)
            if request.action == "kill":
                self._hosts.kill(entry)
        names = [entry.name for entry in entries]
        self._log.info(f"asked to {request.action} {', '.join(names)}")
        self._wait(connection, lambda: self._settled(entries))

    def _take_place(self, request: requests.TakePlace, connection: Connection) -> None:
        component = self._steering.component(request.name)
        host = self._plan.components[component].host
        self._steering.check_needs(self._plan.hosts[host].components)
        self._places.give(host, connection, request.held)
        self._log.info(f"{request.name}: process {connection.pid}, started by hand, takes its place")

    def _settled(self, entries: list[HostEntry]) -> dict[str, Any] | None:
        if not all(entry.settled for entry in entries):
            return None
        states = [{"name": entry.name, "state": entry.state, "reason": entry.reason} for entry in entries]
        stopped = [entry for entry in entries if entry.state == "stopped"]
        return {"tick": self._loop.tick, "processes": states, "left_without": self._steering.left_without(stopped)}

    def _set(self, request: requests.SetSettings, connection: Connection) -> dict[str, Any] | None:
        found = self.settings.check(request.changes)
        if request.check:
            return {"settings": [self._said(new) for new in found]}
        for new in found:
            self.settings.ask(new)
            self._new.append((new, request.origin))
        newest = self._loop.newest_change + len(self._new)
        self._wait(connection, lambda: self._taken_over(found, newest))
        return None

    def _said(self, new: NewSettings) -> dict[str, Any]:
        return {"component": self._plan.components[new.component].name, "values": new.said}

    def _taken_over(self, found: list[NewSettings], number: int) -> dict[str, Any] | None:
        entries = [self._hosts.table[self._plan.components[new.component].host] for new in found]
        if self._loop.newest_change < number:
            return None
        stands = self._loop.stands  # then they have them before they do anything else
        if not stands and any(change.number <= number for entry in entries for change in entry.changes):
            return None
        return {"tick": self._loop.tick + stands, "settings": [self._said(new) for new in found]}

    def _common(self, request: requests.Common, connection: Connection) -> dict[str, Any] | None:
        component = self._plan.components[self._steering.component(request.name)]
        view = component_view(self._plan, component, self._hosts.table[component.host])
        if request.verb == "state":
            return {"name": view["name"], "state": view["state"], "reason": view["reason"]}
        if request.verb == "period":
            return {"name": view["name"], "period_us": period_us(self._plan, component), "stages": view["stages"]}
        if request.verb == "time_awake":
            return {"name": view["name"], "awake_s": view["awake_s"]}
        if request.verb == "parameters":
            rows = self.settings.rows([component.name])
            return {"name": view["name"], "parameters": rows}
        self._steer(requests.Steer(verb="steer", action="kill", names=[component.name]), connection)
        return None

    def _wait(self, connection: Connection, happened: Callable[[], dict[str, Any] | None]) -> None:
        self._waiting.append(_Waiting(connection, happened))

    def _boundary(self, tick: int) -> None:
        """Between two ticks: what was asked for since the last one happens now."""
        self._directing.decide()
        new, self._new = self._new, []
        for each, origin in new:
            self.settings.take(each, f"{origin}, tick {tick}")
            self._loop.change(each.component, each.text)
            name = self._plan.components[each.component].name
            self._log.info(f"{name}: {', '.join(f'{key} = {value}' for key, value in each.said.items())} ({origin})")
        if new:
            self._tell_watchers({self._plan.components[each.component].name for each, _ in new})

    def _tell_watchers(self, names: set[str]) -> None:
        self._watching = [(connection, patterns) for connection, patterns in self._watching if connection.open]
        for connection, patterns in self._watching:
            rows = [row for row in self.settings.rows(patterns) if row["component"] in names]
            if rows:
                connection.stream({"ok": True, "tick": self._loop.tick + 1, "settings": rows})

    def _settings_of(self, entry: HostEntry) -> dict[str, str]:
        entry.started_with = self._loop.newest_change
        return self.settings.changed(self._plan.hosts[entry.index].components)
