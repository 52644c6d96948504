"""The main-loop aspect: a component determines the schedule of the following ticks."""

from collections.abc import Sequence

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
