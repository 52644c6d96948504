"""A component in a replay: built as in its host process, fed from the recording."""

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from fwk.aspects.vision import Ring
from fwk.component import declaration
from fwk.plan.model import ComponentPlan, Plan
from fwk.runner import Runner, Surroundings
from lcmtypes.core import log_t


class Actor:
    """One life of a component, from its start to its end; `settings` are those it was started with."""

    def __init__(
        self,
        plan: Plan,
        component: ComponentPlan,
        incarnation: int,
        rings: Mapping[str, Ring],
        settings: Mapping[str, Any],
    ) -> None:
        self.plan = component
        self._stages = plan.stages
        declared = declaration(getattr(import_module(component.module), component.class_name))
        config = declared.config.model_validate(settings)
        names = [each.name for each in plan.components]
        surroundings = Surroundings(plan.seed, plan.period_us, _silent, rings, stages=plan.stages, components=names)
        self.runner = Runner(declared, component.name, config, component.channels, surroundings, incarnation)
        self._waiting: dict[str, list[bytes]] = {channel: [] for channel in self.runner.readers}
        self.runner.init()

    def continue_at(self, channel: str, sequence: int) -> None:
        """Where a written channel goes on after a restart."""
        if channel in self.runner.writers:
            self.runner.writers[channel].sequence = sequence

    def see(self, channel: str, data: list[bytes]) -> None:
        """Messages became visible; the next iteration has them."""
        if channel in self._waiting:
            self._waiting[channel] += data

    def iterate(self, tick: int, place: int, stage: int, time_us: int) -> list[tuple[str, bytes]]:
        """One iteration with everything that became visible since the last."""
        waiting, self._waiting = self._waiting, {channel: [] for channel in self._waiting}
        written = self.runner.iterate(tick, place, self._stages[stage], time_us, waiting)
        self.runner.wishes()  # what came of them is in the recording
        return written

    def finalize(self, tick: int, time_us: int) -> list[tuple[str, bytes]]:
        """What it writes when it is stopped."""
        return self.runner.finalize(tick, time_us)


def _silent(line: log_t) -> None:
    """The recorded run has logged it already."""
