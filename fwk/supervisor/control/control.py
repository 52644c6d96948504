"""Answers control requests; those that change the run wait for the next boundary."""

import os
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fwk.clock import US_PER_S
from fwk.component.log import LEVELS
from fwk.control import requests
from fwk.control.requests import RequestError
from fwk.control.server import Answer, Connection, Server
from fwk.control.settings import NewSettings, RunSettings
from fwk.model.names import NOTE
from fwk.supervisor.boundary import SettingsChanged, SettingsRequest
from fwk.supervisor.control.clock_control import ClockControl
from fwk.supervisor.control.view import component_view, period_us, times_view
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess, HostState
from fwk.supervisor.lifecycle import Lifecycle
from fwk.supervisor.loop import Loop
from fwk.supervisor.options import RunOptions
from fwk.supervisor.processes.attach import Attach
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import status_t

_FRESH_US = 2 * US_PER_S  # older rates are meaningless

Listen = Callable[[Answer], Server]
"""Opens the control server that hands requests to an answer."""
Reply = dict[str, Any] | None
"""A reply that is sent at once; None: it is sent later."""


@dataclass(frozen=True)
class _Pending:
    """A request that is answered once its effect has occurred."""

    connection: Connection
    happened: Callable[[], Reply]
    """Returns the reply once there is one."""


class Control:
    """Answers the requests of tools: one handler for each type of request."""

    def __init__(
        self,
        core: Core,
        options: RunOptions,
        hosts: Hosts,
        loop: Loop,
        settings: RunSettings,
        lifecycle: Lifecycle[HostProcess],
        attach: Attach,
        listen: Listen | None,
    ) -> None:
        self._core = core
        self._plan = core.plan
        self._options = options
        self._hosts = hosts
        self._loop = loop
        self._settings = settings
        self._lifecycle = lifecycle
        self._attach = attach
        self._clock = ClockControl(loop, core.clock, core.log)
        self._status = status_t()
        self._status_us = 0
        self._pending: list[_Pending] = []
        self._watching: list[tuple[Connection, list[str]]] = []
        self._handlers: dict[type[Any], Callable[[Any, Connection], Reply]] = {
            requests.Run: lambda _request, _connection: self._run(),
            requests.Status: self._answer_status,
            requests.Times: lambda _request, _connection: times_view(self._plan, self._loop.times, core.hosts),
            requests.Steer: self._steer,
            requests.TakePlace: self._take_place,
            requests.SetClock: self._steer_clock,
            requests.Settings: lambda request, _: {"settings": self._settings.rows(request.names)},
            requests.SetSettings: self._set,
            requests.WatchSettings: self._watch_settings,
            requests.Note: self._note,
            requests.Common: self._common,
        }
        self._server = listen(self.take) if listen else None
        if self._server:
            core.events.watch(self._server, self._server.handle)
        core.events.subscribe(SettingsChanged, self._tell_watchers)
        core.events.after_each_wait(self._answer_pending)

    def close(self) -> None:
        """Stops taking and answering requests."""
        self._pending = []
        if self._server:
            self._core.events.unwatch(self._server)
            self._server.close()

    def published(self, status: status_t) -> None:
        """Takes the newest published status, whose rates are part of replies."""
        self._status, self._status_us = status, self._core.now_us()

    def take(self, line: bytes, connection: Connection) -> None:
        """Answers a control request at once, later, or repeatedly."""
        try:
            request = requests.parsed(requests.to_supervisor, line)
            reply = self._handlers[type(request)](request, connection)
        except RequestError as error:
            connection.refuse(str(error))
            return
        except Exception as error:  # a defect here must not end the run
            self._core.log.error(f"cannot answer {line[:200]!r}: {type(error).__name__}: {error}")
            connection.refuse(f"the run cannot answer this: {type(error).__name__}: {error}")
            return
        if reply is not None:
            connection.reply({"ok": True, **reply})

    def _answer_pending(self) -> None:
        if not self._pending:
            return
        still = []
        for pending in self._pending:
            reply = pending.happened()
            if reply is not None:
                pending.connection.reply({"ok": True, **reply})
            elif pending.connection.open:
                still.append(pending)
        self._pending = still

    def _answer_when(self, connection: Connection, happened: Callable[[], Reply]) -> None:
        self._pending.append(_Pending(connection, happened))

    def _answer_status(self, request: requests.Status, _connection: Connection) -> Reply:
        return {**self._run(), **self._now(), "components": self._components(request.names)}

    def _steer_clock(self, request: requests.SetClock, connection: Connection) -> Reply:
        self._answer_when(connection, self._clock.ask(request))
        return None

    def _watch_settings(self, request: requests.WatchSettings, connection: Connection) -> Reply:
        rows = self._settings.rows(request.names)
        self._watching.append((connection, request.names))
        return {"settings": rows}

    def _note(self, request: requests.Note, _connection: Connection) -> Reply:
        self._core.log.write(LEVELS[request.level], request.text, NOTE, 0)
        return {"tick": self._loop.tick}

    def _run(self) -> dict[str, Any]:
        record, plan = self._options.record, self._plan
        return {
            "name": self._options.name or plan.name,
            "plan": plan.name,
            "file": plan.file,
            "folders": list(plan.folders),
            "run_dir": str(self._options.run_dir),
            "record": str(record) if record else "",
            "pid": os.getpid(),
            "bus_port": plan.bus_port,
            "public_url": plan.public_url,
            "seed": plan.seed,
            "clock": plan.clock,
            "period_us": plan.period_us,
            "watching": len(self._watching),
        }

    def _now(self) -> dict[str, Any]:
        fresh = self._core.now_us() < self._status_us + _FRESH_US
        return {
            **self._clock.now(),
            "speed": self._status.speed if fresh else 0.0,
            "ticks_per_s": self._status.ticks_per_s if fresh else 0.0,
            "repeated": self._loop.barrier.repeated,
            "late": self._loop.barrier.late,
            "waits_for": self._loop.waits_for,
            "main_loop": self._loop.schedule.holder_name,
            "order": self._loop.schedule.stage_names,
        }

    def _components(self, names: list[str]) -> list[dict[str, Any]]:
        chosen = self._lifecycle.components(names or ["*"])
        components = [self._plan.components[index] for index in chosen]
        return [component_view(self._plan, each, self._core.hosts[each.host]) for each in components]

    def _steer(self, request: requests.Steer, connection: Connection) -> Reply:
        hosts = self._lifecycle.hosts(request.action, request.names, request.force)
        for host in hosts:
            self._lifecycle.request(request.action, host, self._core.now_us())
            self._hosts.request(host)
            if request.action == "kill":
                self._hosts.kill(host)
        self._core.log.info(f"asked to {request.action} {', '.join(host.name for host in hosts)}")
        self._answer_when(connection, lambda: self._settled(hosts))
        return None

    def _take_place(self, request: requests.TakePlace, connection: Connection) -> Reply:
        component = self._lifecycle.component(request.name)
        host = self._plan.components[component].host
        self._lifecycle.check_needs(self._plan.hosts[host].components)
        self._attach.give(host, connection, request.held)
        self._core.log.info(f"{request.name}: process {connection.pid}, an external process, takes its place")
        return None

    def _settled(self, hosts: list[HostProcess]) -> Reply:
        if not all(host.settled for host in hosts):
            return None
        states = [{"name": host.name, "state": host.state, "reason": host.reason} for host in hosts]
        stopped = [host for host in hosts if host.state is HostState.STOPPED]
        return {"tick": self._loop.tick, "processes": states, "left_without": self._lifecycle.left_without(stopped)}

    def _set(self, request: requests.SetSettings, connection: Connection) -> Reply:
        found = self._settings.check(request.changes)
        if request.check:
            return {"settings": [self._values(new) for new in found]}
        asked = [self._loop.boundary.ask_settings(new, request.origin) for new in found]
        self._answer_when(connection, lambda: self._taken_over(asked))
        return None

    def _values(self, new: NewSettings) -> dict[str, Any]:
        return {"component": self._plan.components[new.component].name, "values": new.said}

    def _taken_over(self, asked: list[SettingsRequest]) -> Reply:
        if not all(each.number for each in asked):
            return None
        newest = max((each.number for each in asked), default=0)
        paused = self._loop.paused  # then components have the settings before any other step
        waiting = (change.number for each in asked for change in self._core.host_of(each.new.component).changes)
        if not paused and any(number <= newest for number in waiting):
            return None
        return {"tick": self._loop.tick + paused, "settings": [self._values(each.new) for each in asked]}

    def _common(self, request: requests.Common, connection: Connection) -> Reply:
        component = self._plan.components[self._lifecycle.component(request.name)]
        view = component_view(self._plan, component, self._core.hosts[component.host])
        if request.verb == "state":
            return {"name": view["name"], "state": view["state"], "reason": view["reason"]}
        if request.verb == "period":
            return {"name": view["name"], "period_us": period_us(self._plan, component), "stages": view["stages"]}
        if request.verb == "time_awake":
            return {"name": view["name"], "awake_s": view["awake_s"]}
        if request.verb == "parameters":
            return {"name": view["name"], "parameters": self._settings.rows([component.name])}
        return self._steer(requests.Steer(verb="steer", action="kill", names=[component.name]), connection)

    def _tell_watchers(self, event: SettingsChanged) -> None:
        self._watching = [(connection, patterns) for connection, patterns in self._watching if connection.open]
        for connection, patterns in self._watching:
            rows = [row for row in self._settings.rows(patterns) if row["component"] in event.components]
            if rows:
                connection.stream({"ok": True, "tick": self._loop.tick + 1, "settings": rows})
