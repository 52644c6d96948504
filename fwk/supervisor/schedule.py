"""The order in which a tick runs stages: the plan's, or that of the component that has the main loop."""

from collections.abc import Sequence
from typing import NamedTuple

from fwk.bus.sync import place_of
from fwk.component.log import Logger
from fwk.component.main_loop import Holding
from fwk.model.plan import NOBODY, Plan
from fwk.supervisor.processes.host_process import HostEntry
from lcmtypes.core import done_t


class Turn(NamedTuple):
    """One run of a stage in a tick."""

    place: int
    """In the tick's order; the stage's index if nobody has the main loop."""
    stage: int
    members: list[HostEntry]


class Turns:
    """The turns of the next tick, and who decides about them."""

    def __init__(self, plan: Plan, by_stage: Sequence[list[HostEntry]], log: Logger) -> None:
        self.holder = NOBODY
        """Index of the component that has the main loop."""
        self._plan = plan
        self._by_stage = by_stage
        self._log = log
        self._index = {component.name: component.index for component in plan.components}
        self._stage_index = {name: index for index, name in enumerate(plan.stages)}
        names = {each.name: [plan.stages[stage] for stage in each.stages] for each in plan.components}
        self._holding = Holding(names)
        self._usual = [Turn(stage, stage, members) for stage, members in enumerate(by_stage) if members]
        self.now = self._usual

    @property
    def view(self) -> dict[str, object]:
        """Who has the main loop and what it runs, by name."""
        return {"main_loop": self._holding.holder, "order": list(self._holding.order)}

    @property
    def asked(self) -> bool:
        """Whether there is something to decide."""
        return self._holding.asked

    def ask(self, done: done_t) -> None:
        """Takes the requests for the main loop in a done."""
        for request in done.main_loop:
            order = [self._plan.stages[stage] for stage in request.schedule]
            name = self._plan.components[request.component].name
            self._holding.ask(done.tick, place_of(done), name, order)

    def left(self, host: int) -> None:
        """A host ended or leaves the loop."""
        self._holding.left([self._plan.components[index].name for index in self._plan.hosts[host].components])

    def decide(self, tick: int) -> bool:
        """At the boundary before a tick; whether somebody else decides about the turns from now on, or others run."""
        before, changed = self._holding.holder, self._holding.decide()
        for text in self._holding.refused:
            self._log.warning(text)
        holder = self._holding.holder
        if changed and holder:
            self._log.warning(f"{holder} has the main loop from tick {tick} on: {', '.join(self._holding.order)}")
        elif changed:
            self._log.warning(f"{before} has given the main loop back; tick {tick} runs the usual stages")
        self.holder = self._index[holder] if holder else NOBODY
        order = [self._stage_index[name] for name in self._holding.order]
        self.now = [Turn(place, stage, self._by_stage[stage]) for place, stage in enumerate(order)] or self._usual
        return changed
