"""What components ask of the blackboard on its way into the run: decided between two ticks, told, recorded."""

from collections.abc import Callable, Sequence
from typing import Any

from fwk.bus.sync import place_of
from fwk.component.log import Logger
from fwk.engine.channel_grants import Openings
from fwk.engine.visibility import Ledger
from fwk.model.channel_table import Fact, text_of
from fwk.model.plan import Plan
from fwk.model.requests import channel_request_of
from fwk.supervisor.processes.host_process import Change, HostEntry
from fwk.supervisor.processes.hosts import Hosts
from lcmtypes.core import done_t


class Opening:
    """Of a run in which components may open channels; `change` makes a decision part of the tick that is to begin."""

    def __init__(
        self, plan: Plan, hosts: Hosts, ledger: Ledger, change: Callable[[Sequence[Fact]], Change], log: Logger
    ) -> None:
        self._plan = plan
        self._hosts = hosts
        self._ledger = ledger
        self._change = change
        self._log = log
        self._openings = Openings(plan)
        self._written = {channel.index for channel in plan.channels}  # all channels that somebody has written

    @property
    def asked(self) -> bool:
        """Whether there is something to decide."""
        return self._openings.asked

    def snapshot(self) -> str:
        """The blackboard as it is, for a host that starts."""
        return text_of(self._openings.instances.snapshot())

    def ask(self, done: done_t) -> None:
        """Takes the requests for dynamic channels in a done."""
        asked: dict[str, list[list[Any]]] = {}
        for request in done.channels:
            asked.setdefault(self._plan.components[request.component].name, []).append(channel_request_of(request))
        for name, requests in asked.items():
            self._openings.ask(done.tick, place_of(done), name, requests)

    def came(self, entry: HostEntry) -> None:
        """A host takes part in the run from now on."""
        for component in self._plan.hosts[entry.index].components:
            self._openings.came(component, entry.incarnation)

    def left(self, entry: HostEntry) -> None:
        """A host ended or leaves the loop; what its components had opened is closed."""
        for component in self._plan.hosts[entry.index].components:
            self._openings.left(component)

    def decide(self) -> Change | None:
        """Decides at a boundary; returns the change if channels are written by it that never were before."""
        facts, _ = self._openings.decide(self._busy)
        announced = None
        if facts:
            written = {fact.opening.channel for fact in facts if fact.kind == "write" and fact.opening}
            change = self._change([self._numbered(fact) for fact in facts])
            announced = None if written <= self._written else change
            self._written |= written
            self._ledger.opened(self._openings.instances)
        for fact in facts:
            if fact.kind == "refuse":
                self._log.warning(f"{self._plan.components[fact.component].name}: {fact.reason}; refused")
        return announced

    def _numbered(self, fact: Fact) -> Fact:
        """A writer goes on where the channel is."""
        return fact.numbered(self._ledger.latest(fact.opening.channel)) if fact.opening else fact

    def _busy(self, component: int) -> bool:
        entry = self._hosts.table[self._plan.components[component].host]
        return entry.busy is not None or entry.index in self._hosts.leaving
