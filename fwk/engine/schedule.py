"""The schedule: the stages of a tick in the order in which they run, and the component that determines them."""

from collections.abc import Container, Sequence

from fwk.model.plan import NOBODY, Plan
from lcmtypes.core import main_loop_request_t


class Schedule:
    """Decides which component holds the main loop, and with which schedule; requests are decided at boundaries."""

    def __init__(self, plan: Plan) -> None:
        self.holder = NOBODY
        """Index of the component that holds the main loop."""
        self.order: tuple[int, ...] = ()
        """Stages of the holder's schedule; empty: the plan's schedule."""
        self.refused: list[str] = []
        """Messages about requests that were refused at the last boundary."""
        self._components = plan.components
        self._stages = plan.stages
        used = {stage for component in plan.components for stage in component.stages}
        self._usual = [(stage, stage) for stage in sorted(used)]
        self.steps: Sequence[tuple[int, int]] = self._usual
        """Step and stage of each run of a stage in the next tick; stages without components are left out."""
        self._requests: list[tuple[tuple[int, int, str], main_loop_request_t]] = []
        self._left = False

    @property
    def holder_name(self) -> str:
        """Full name of the component that holds the main loop; empty if there is none."""
        return self._components[self.holder].name if self.holder != NOBODY else ""

    @property
    def stage_names(self) -> list[str]:
        """Names of the stages of the next tick, in their order."""
        return [self._stages[stage] for _, stage in self.steps]

    @property
    def asked(self) -> bool:
        """Whether there is something to decide."""
        return self._left or bool(self._requests)

    def ask(self, tick: int, step: int, request: main_loop_request_t) -> None:
        """Adds a request that a component made at a step of a tick; an empty schedule gives the main loop back."""
        self._requests.append(((tick, step, self._components[request.component].name), request))

    def left(self, components: Container[int]) -> None:
        """Gives back what components held whose process ended, and drops their requests."""
        self._left = self._left or self.holder in components
        self._requests = [each for each in self._requests if each[1].component not in components]

    def decide(self) -> bool:
        """Decides the requests of a boundary in their order; returns whether holder or schedule changed."""
        before = (self.holder, self.order)
        self.refused = []
        if self._left:
            self.holder, self.order, self._left = NOBODY, (), False
        for _, request in sorted(self._requests, key=lambda each: each[0]):
            self._grant(request.component, tuple(request.schedule))
        self._requests = []
        changed = (self.holder, self.order) != before
        if changed:
            self.steps = list(enumerate(self.order)) or self._usual
        return changed

    def _grant(self, component: int, order: tuple[int, ...]) -> None:
        own, name = self._components[component].stages, self._components[component].name
        if not order:
            if self.holder == component:
                self.holder, self.order = NOBODY, ()
        elif self.holder not in (NOBODY, component):
            self.refused.append(
                f"{name} wants the main loop, but {self.holder_name} has it; refused until that gives it back"
            )
        elif own and not set(order) & set(own):
            self.refused.append(
                f"{name} wants the main loop for {self._names(order)}; refused: without a stage of its own "
                f"({self._names(own)}) it could never give it back"
            )
        else:
            self.holder, self.order = component, order

    def _names(self, stages: Sequence[int]) -> str:
        return ", ".join(self._stages[stage] for stage in stages)
