"""The boundary between two ticks: everything that changes the run takes effect here, in one order."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from fwk.bus.network import Steps
from fwk.control.settings import NewSettings
from fwk.engine.boundary import AFTER_ALL_STEPS, TOOLS, BoundaryRequest, BoundaryRequests
from fwk.engine.schedule import Schedule
from fwk.model import tick_events
from fwk.model.tick_events import HostStarted, HostStopped, MainLoopGiven
from fwk.supervisor.barrier import LOOK_US, Barrier
from fwk.supervisor.changes import Changes
from fwk.supervisor.channel_requests import ChannelRequests
from fwk.supervisor.core import Core
from fwk.supervisor.host_events import HostEnded, HostLeaves, HostReady
from fwk.supervisor.host_process import HostProcess
from fwk.supervisor.lifecycle import Lifecycle, PluginRequests
from fwk.supervisor.processes.hosts import Hosts
from fwk.supervisor.tick_log import TickLog


@dataclass
class SettingsRequest:
    """New settings of a component, requested by a tool."""

    new: NewSettings
    origin: str
    """Name of the tool."""
    number: int = 0
    """Number of the change that a boundary made of it; 0: none yet."""


@dataclass(frozen=True)
class SettingsChanged:
    """Components have new settings from the next tick on."""

    components: frozenset[str]
    """Full names."""


class Boundary:
    """Carries out the requests since the last boundary.

    The order is fixed: requests set desired states and settings; leaving hosts finalize; main loop and dynamic
    channels are decided; joining hosts are started with the state after these decisions. In lockstep the boundary
    waits until the former have left and the latter are ready or have failed, so nothing depends on wall time.
    """

    def __init__(
        self,
        core: Core,
        hosts: Hosts,
        schedule: Schedule,
        channels: ChannelRequests,
        changes: Changes,
        requests: BoundaryRequests,
        lifecycle: Lifecycle[HostProcess],
        barrier: Barrier,
        tick_log: TickLog,
    ) -> None:
        self.requests = requests
        self._core = core
        self._hosts = hosts
        self._schedule = schedule
        self._channels = channels
        self._changes = changes
        self._barrier = barrier
        self._tick_log = tick_log
        plugins = PluginRequests(core, hosts, lifecycle)
        self._handlers: dict[str, Callable[[BoundaryRequest], None]] = {
            "main_loop": lambda asked: schedule.ask(asked.tick, asked.step, asked.content),
            "channels": lambda asked: channels.ask(asked.tick, asked.step, asked.content),
            "plugins": lambda asked: plugins.decide(asked.content),
            "settings": self._set,
        }
        core.events.subscribe(HostReady, self._take_ready)
        core.events.subscribe(HostEnded, self._take_lost)
        core.events.subscribe(HostLeaves, self._take_leaves)

    def ask_settings(self, new: NewSettings, origin: str) -> SettingsRequest:
        """Gives a component new settings at the next boundary; `origin` names the requesting tool."""
        asked = SettingsRequest(new, origin)
        self._changes.settings.ask(new)
        self.requests.ask(self._core.clock.tick, AFTER_ALL_STEPS, TOOLS, "settings", asked)
        return asked

    def cross(self) -> Steps[None]:
        """Carries out all requests."""
        hosts, lockstep = self._hosts, self._core.lockstep
        self._decide()
        hosts.retire()
        self._core.events.dispatch()
        if hosts.unsettled:
            hosts.enforce_timeouts()
            if lockstep:
                yield from self._until_left()
        if self._schedule.asked:
            self._decide_main_loop()
        if self._channels.asked:
            announced = self._channels.decide()
            if announced:
                yield from self._tick_log.announce(announced, self._barrier.announce_us, self._core.interrupted)
        hosts.admit()
        if hosts.unsettled:
            hosts.start_due()
            if lockstep:
                yield from self._until_ready()

    def _decide(self) -> None:
        if not self.requests:
            return
        changed: set[str] = set()
        for request in self.requests.take():
            self._handlers[request.kind](request)
            if request.kind == "settings":
                changed.add(self._core.plan.components[request.content.new.component].name)
        if changed:
            self._core.events.emit(SettingsChanged(frozenset(changed)))

    def _set(self, request: BoundaryRequest) -> None:
        asked: SettingsRequest = request.content
        new, origin = asked.new, asked.origin
        self._changes.settings.take(new, f"{origin}, tick {self._core.clock.tick + 1}")
        asked.number = self._changes.change_settings(new.component, new.text).number
        name = self._core.plan.components[new.component].name
        self._core.log.info(f"{name}: {', '.join(f'{key} = {value}' for key, value in new.said.items())} ({origin})")

    def _decide_main_loop(self) -> None:
        schedule, log, tick, before = (
            self._schedule,
            self._core.log,
            self._core.clock.tick + 1,
            self._schedule.holder_name,
        )
        changed = schedule.decide()
        for text in schedule.refused:
            log.warning(text)
        if changed:
            self._tick_log.event(MainLoopGiven(schedule.holder))
        if changed and schedule.holder_name:
            log.warning(
                f"{schedule.holder_name} has the main loop from tick {tick} on: {', '.join(schedule.stage_names)}"
            )
        elif changed:
            log.warning(f"{before} has given the main loop back; tick {tick} runs the usual stages")

    def _until_left(self) -> Steps[None]:
        """Waits until hosts that stop have finalized, and until those that restart have ended."""
        began_us = self._core.now_us()
        while leaving := self._staged(lambda host: host.finalizing or (host.stopping and host.wanted)):
            yield from self._wait_for(leaving, began_us)
            self._hosts.enforce_timeouts()

    def _until_ready(self) -> Steps[None]:
        """Waits until joining hosts are ready or have failed, whether or not the schedule has their stages."""
        began_us = self._core.now_us()
        while coming := self._staged(lambda host: host.coming):
            yield from self._wait_for(coming, began_us)
            self._hosts.enforce_timeouts()
            self._hosts.start_due()

    def _staged(self, concerned: Callable[[HostProcess], bool]) -> list[HostProcess]:
        """Returns the hosts to wait for: never continuous ones, and none once the run is asked to end."""
        if self._core.interrupted():
            return []
        return [host for host in self._core.hosts if concerned(host) and not host.continuous]

    def _wait_for(self, hosts: Sequence[HostProcess], began_us: int) -> Steps[None]:
        report, core = self._barrier.report, self._core
        report.waiting(began_us, hosts, f"tick {core.clock.tick + 1}")
        yield from core.events.wait(core.now_us() + LOOK_US)
        report.ended()

    def _take_ready(self, event: HostReady) -> None:
        host = event.host
        self._tick_log.event(HostStarted(host.index, host.incarnation, host.started_with))
        if host.incarnation > 1:
            self._core.log.info(f"{host.name} runs again, incarnation {host.incarnation}")
        self._barrier.joined()
        self._channels.came(host)

    def _take_lost(self, event: HostEnded) -> None:
        self._tick_log.event(tick_events.HostLost(event.host.index))
        self._forget(event.host)
        self._barrier.lost(event.host)

    def _take_leaves(self, event: HostLeaves) -> None:
        self._tick_log.event(HostStopped(event.host.index))
        self._forget(event.host)

    def _forget(self, host: HostProcess) -> None:
        """Drops the requests and grants of a host that takes no part any more."""
        names = [self._core.plan.components[index].name for index in self._core.components_of(host)]
        self.requests.drop(names, ("main_loop", "channels"))
        self._schedule.left(self._core.components_of(host))
        self._channels.left(host)
