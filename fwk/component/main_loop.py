"""The main-loop aspect: a component decides which stages the following ticks run, in which order and how often."""

from collections.abc import Mapping, Sequence

RUNS_MAX = 1000
"""Stages that a tick can run, repeated ones counted each time."""


class MainLoop:
    """Lets a component take over the main loop and give it back; both count from the next tick on.

    One component has it at a time. Who asks while another has it is refused: the log says so, and `holder` is the
    other's name. Whoever has it may ask again, for another order. It is given back when the component's process ends.
    """

    def __init__(self, name: str, stages: Sequence[str]) -> None:
        self.stages = tuple(stages)
        """Those of the plan, in their usual order."""
        self.holder = ""
        """Full name of the component that has the main loop in this tick; empty: nobody."""
        self._name = name
        self._wish: tuple[str, ...] | None = None

    @property
    def mine(self) -> bool:
        """Whether this component has the main loop in this tick."""
        return self.holder == self._name

    def take_over(self, order: Sequence[str]) -> None:
        """From the next tick on these stages run, in this order; one that stands here twice runs twice a tick.

        A stage of the component itself has to be among them, unless it is continuous, or it could never give the main
        loop back.

        Raises:
            ValueError: the plan has no such stage, or the order is empty or too long.
        """
        unknown = [stage for stage in order if stage not in self.stages]
        if unknown:
            raise ValueError(f"{self._name}: no stage '{unknown[0]}'; the stages are {', '.join(self.stages)}")
        if not 1 <= len(order) <= RUNS_MAX:
            raise ValueError(f"{self._name}: a tick runs 1 to {RUNS_MAX} stages, not {len(order)}")
        self._wish = tuple(order)

    def give_back(self) -> None:
        """From the next tick on the plan's stages run as usual."""
        self._wish = ()

    def take(self) -> tuple[str, ...] | None:
        """For the framework: what was asked in this iteration; empty: to give it back; None: nothing."""
        wish, self._wish = self._wish, None
        return wish


class Holding:
    """Who has the main loop, and the order of its ticks; wishes are granted between two ticks.

    `stages` are the stages of each component that may ask; a continuous one has none.
    """

    def __init__(self, stages: Mapping[str, Sequence[str]]) -> None:
        self.holder = ""
        self.order: tuple[str, ...] = ()
        """Stages of a tick; empty: as usual."""
        self.refused: list[str] = []
        """Sentences about wishes that were not granted at the last boundary."""
        self._stages = stages
        self._wishes: list[tuple[tuple[int, int, str], tuple[str, ...]]] = []
        self._left = False

    def ask(self, tick: int, place: int, name: str, order: Sequence[str]) -> None:
        """A component asks, in its iteration at that place of that tick; an empty order gives back."""
        self._wishes.append(((tick, place, name), tuple(order)))

    def left(self, names: Sequence[str]) -> None:
        """The process of these components ended: what they held is given back, what they asked before is void."""
        self._left = self._left or self.holder in names
        self._wishes = [wish for wish in self._wishes if wish[0][2] not in names]

    def decide(self) -> bool:
        """Between two ticks: grants what can be granted, the earlier before the later; whether anything changed."""
        before = (self.holder, self.order)
        self.refused = []
        if self._left:
            self.holder, self.order, self._left = "", (), False
        for (_, _, name), order in sorted(self._wishes):
            self._grant(name, order)
        self._wishes = []
        return (self.holder, self.order) != before

    @property
    def asked(self) -> bool:
        """Whether there is something to decide."""
        return self._left or bool(self._wishes)

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
