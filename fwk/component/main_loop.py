"""The main-loop aspect: a component determines the schedule of the following ticks."""

from collections.abc import Mapping, Sequence

STEPS_MAX = 1000
"""Longest schedule of a tick, in steps."""


class MainLoop:
    """Takes over the main loop and gives it back; both take effect at the next tick.

    One component holds the main loop at a time. While another component holds it, a take-over is refused: the log says
    so, and `holder` names the other component. The holder may take over again with another schedule. The main loop is
    given back when the process of its holder ends.
    """

    def __init__(self, name: str, stages: Sequence[str]) -> None:
        self.stages = tuple(stages)
        """Stages of the plan, in the plan's order."""
        self.holder = ""
        """Full name of the component that holds the main loop in this tick; empty if there is none."""
        self._name = name
        self._request: tuple[str, ...] | None = None

    @property
    def mine(self) -> bool:
        """Whether this component holds the main loop in this tick."""
        return self.holder == self._name

    def take_over(self, order: Sequence[str]) -> None:
        """Sets the schedule from the next tick on; a stage may occur in it several times.

        The schedule must contain a stage of this component, unless it is continuous; otherwise the component could
        never give the main loop back.

        Raises:
            ValueError: the plan has no such stage, or the schedule is empty or too long.
        """
        unknown = [stage for stage in order if stage not in self.stages]
        if unknown:
            raise ValueError(f"{self._name}: no stage '{unknown[0]}'; the stages are {', '.join(self.stages)}")
        if not 1 <= len(order) <= STEPS_MAX:
            raise ValueError(f"{self._name}: a schedule has 1 to {STEPS_MAX} stages, not {len(order)}")
        self._request = tuple(order)

    def give_back(self) -> None:
        """Restores the plan's schedule from the next tick on."""
        self._request = ()

    def _take(self) -> tuple[str, ...] | None:
        """Returns the iteration's request: a schedule; empty to give the main loop back; None for no request."""
        request, self._request = self._request, None
        return request


class Holding:
    """Decides which component holds the main loop, and with which schedule; requests are decided at boundaries.

    `stages` are the stages of each component that may request the main loop; a continuous component has none.
    """

    def __init__(self, stages: Mapping[str, Sequence[str]]) -> None:
        self.holder = ""
        self.order: tuple[str, ...] = ()
        """Schedule of the holder; empty: the plan's schedule."""
        self.refused: list[str] = []
        """Messages about requests that were refused at the last boundary."""
        self._stages = stages
        self._requests: list[tuple[tuple[int, int, str], tuple[str, ...]]] = []
        self._left = False

    def ask(self, tick: int, step: int, name: str, order: Sequence[str]) -> None:
        """Adds a component's request, made at a step of a tick; an empty order gives the main loop back."""
        self._requests.append(((tick, step, name), tuple(order)))

    def left(self, names: Sequence[str]) -> None:
        """Gives back what components held whose process ended, and drops their requests."""
        self._left = self._left or self.holder in names
        self._requests = [request for request in self._requests if request[0][2] not in names]

    def decide(self) -> bool:
        """Decides the requests of a boundary in their order; returns whether holder or schedule changed."""
        before = (self.holder, self.order)
        self.refused = []
        if self._left:
            self.holder, self.order, self._left = "", (), False
        for (_, _, name), order in sorted(self._requests):
            self._grant(name, order)
        self._requests = []
        return (self.holder, self.order) != before

    @property
    def asked(self) -> bool:
        """Whether there is something to decide."""
        return self._left or bool(self._requests)

    def _grant(self, name: str, order: tuple[str, ...]) -> None:
        if not order:
            if self.holder == name:
                self.holder, self.order = "", ()
        elif self.holder and self.holder != name:
            self.refused.append(
                f"{name} wants the main loop, but {self.holder} has it; refused until that gives it back"
            )
        elif self._stages[name] and not set(order) & set(self._stages[name]):
            own = ", ".join(self._stages[name])
            self.refused.append(
                f"{name} wants the main loop for {', '.join(order)}; refused: without a stage of its own ({own}) "
                "it could never give it back"
            )
        else:
            self.holder, self.order = name, order
