"""Requests for dynamic channels: decided at boundaries, sent to the hosts, recorded."""

from fwk.engine.channel_grants import ChannelGrants
from fwk.model.channel_table import Fact, text_of
from fwk.model.requests import channel_request_of
from fwk.model.tick_events import ChannelsChanged
from fwk.supervisor.changes import Changes
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import Change, HostProcess
from fwk.supervisor.tick_log import TickLog
from lcmtypes.core import channel_request_t


class ChannelRequests:
    """Decides about dynamic channels, in a run whose components may open some."""

    def __init__(self, core: Core, changes: Changes, tick_log: TickLog) -> None:
        self._core = core
        self._changes = changes
        self._tick_log = tick_log
        self._exist = any(component.opens for component in core.plan.components)
        self._grants = ChannelGrants(core.plan)
        self._written = {channel.index for channel in core.plan.channels}  # all channels that ever had a writer

    @property
    def asked(self) -> bool:
        """Whether there are requests to decide."""
        return self._exist and self._grants.asked

    def snapshot(self) -> str:
        """Returns the present table of dynamic channels, for a starting host."""
        return text_of(self._grants.table.snapshot()) if self._exist else "[]"

    def ask(self, tick: int, step: int, request: channel_request_t) -> None:
        """Takes a request for a dynamic channel."""
        if self._exist:
            name = self._core.plan.components[request.component].name
            self._grants.ask(tick, step, name, [channel_request_of(request)])

    def came(self, host: HostProcess) -> None:
        """Notes that a host takes part in the run."""
        for component in self._core.components_of(host) if self._exist else ():
            self._grants.came(component, host.incarnation)

    def left(self, host: HostProcess) -> None:
        """Notes that a host ended or leaves the loop; the channels that its components had open are closed."""
        for component in self._core.components_of(host) if self._exist else ():
            self._grants.left(component)

    def decide(self) -> Change | None:
        """Decides at a boundary; returns the change if it gives a writer to channels that never had one."""
        facts, _ = self._grants.decide(self._busy)
        announced = None
        if facts:
            written = {fact.channel.index for fact in facts if fact.kind == "write" and fact.channel}
            change = self._changes.change_channels([self._numbered(fact) for fact in facts])
            self._tick_log.event(ChannelsChanged(change.number))
            announced = None if written <= self._written else change
            self._written |= written
            self._core.ledger.opened(self._grants.table)
        for fact in facts:
            if fact.kind == "refuse":
                self._core.log.warning(f"{self._core.plan.components[fact.component].name}: {fact.reason}; refused")
        return announced

    def _numbered(self, fact: Fact) -> Fact:
        """Adds the newest sequence number of the channel, from which its writer continues."""
        return fact.numbered(self._core.ledger.latest(fact.channel.index)) if fact.channel else fact

    def _busy(self, component: int) -> bool:
        host = self._core.host_of(component)
        return host.late_with is not None or host.finalizing
