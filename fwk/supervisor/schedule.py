"""The stages of a tick in the order in which they run: the plan's, or that of the component with the main loop."""

from typing import NamedTuple

from fwk.component.main_loop import Holding
from fwk.model.plan import NOBODY
from fwk.supervisor.core import Core
from fwk.supervisor.host_process import HostProcess
from lcmtypes.core import main_loop_request_t


class Turn(NamedTuple):
    """One run of a stage in a tick."""

    step: int
    """Position in the schedule; the index of the stage if no component has the main loop."""
    stage: int
    hosts: list[HostProcess]


class Schedule:
    """The turns of the next tick, and the component that decides them."""

    def __init__(self, core: Core) -> None:
        self.holder = NOBODY
        """Index of the component that has the main loop."""
        plan = core.plan
        self._core = core
        self._index = {component.name: component.index for component in plan.components}
        self._stage_index = {name: index for index, name in enumerate(plan.stages)}
        self._hosts = [self._hosts_of(stage) for stage in range(len(plan.stages))]
        names = {each.name: [plan.stages[stage] for stage in each.stages] for each in plan.components}
        self._holding = Holding(names)
        self._usual = [Turn(stage, stage, hosts) for stage, hosts in enumerate(self._hosts) if hosts]
        self.turns = self._usual

    @property
    def view(self) -> dict[str, object]:
        """The component that has the main loop and the stages that it runs, by name."""
        return {"main_loop": self._holding.holder, "order": list(self._holding.order)}

    @property
    def asked(self) -> bool:
        """Whether there is a request to decide."""
        return self._holding.asked

    def ask(self, tick: int, step: int, request: main_loop_request_t) -> None:
        """Takes a request for the main loop; an empty schedule gives it back."""
        plan = self._core.plan
        order = [plan.stages[stage] for stage in request.schedule]
        self._holding.ask(tick, step, plan.components[request.component].name, order)

    def left(self, host: HostProcess) -> None:
        """Notes that a host ended or leaves the loop."""
        self._holding.left([self._core.plan.components[index].name for index in self._core.components_of(host)])

    def decide(self, tick: int) -> bool:
        """Decides at the boundary before a tick; returns whether the main loop changes hands or its order changes."""
        before, changed = self._holding.holder, self._holding.decide()
        log = self._core.log
        for text in self._holding.refused:
            log.warning(text)
        holder = self._holding.holder
        if changed and holder:
            log.warning(f"{holder} has the main loop from tick {tick} on: {', '.join(self._holding.order)}")
        elif changed:
            log.warning(f"{before} has given the main loop back; tick {tick} runs the usual stages")
        self.holder = self._index[holder] if holder else NOBODY
        order = [self._stage_index[name] for name in self._holding.order]
        self.turns = [Turn(step, stage, self._hosts[stage]) for step, stage in enumerate(order)] or self._usual
        return changed

    def _hosts_of(self, stage: int) -> list[HostProcess]:
        components = self._core.plan.components
        return [
            host
            for host in self._core.hosts
            if any(stage in components[index].stages for index in self._core.components_of(host))
        ]
