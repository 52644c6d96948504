"""Scenarios: what must happen in a run, eventually, in this order, always, or in the end."""

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any

from pydantic import AllowInfNan, BaseModel, ConfigDict, Field, PrivateAttr, Strict

from fwk.testing.document import Document
from fwk.testing.expression import Expression, Words

_SHORTEST_S = 0.001  # the shortest tick
_LONGEST_S = 86_400.0


class Expectations(BaseModel):
    """Conditions of a scenario; the texts are those of `Expression`."""

    model_config = ConfigDict(extra="forbid")

    eventually: list[str] = []
    """Each must hold at some time."""
    in_order: list[str] = []
    """Each must hold at some time, not before the one above it."""
    always: list[str] = []
    """Each must hold in every tick."""
    at_end: list[str] = []
    """Each must hold in the last tick."""
    time_s: Annotated[float, Field(ge=_SHORTEST_S, le=_LONGEST_S), AllowInfNan(False), Strict()] = 10.0
    """Limit of the logical time. Without `always` and `at_end` a scenario ends once all the rest has happened."""
    _places: dict[tuple[str, int], str] = PrivateAttr({})

    @property
    def conditions(self) -> list[tuple[tuple[str, int], str]]:
        """All conditions, each after its path."""
        kinds = {kind: getattr(self, kind) for kind in ("eventually", "in_order", "always", "at_end")}
        return [((kind, place), text) for kind, texts in kinds.items() for place, text in enumerate(texts)]

    def written_in(self, document: Document) -> None:
        """Takes file and line of each condition from the document, for errors of the run."""
        self._places = {path: document.place(*path) for path, _ in self.conditions}


@dataclass
class Verdict:
    """Result of a scenario."""

    time_s: float = 0.0
    """Logical time that was played."""
    broken: list[str] = field(default_factory=list)
    """Conditions that do not hold, with the time for those that had to hold always; empty: the scenario succeeded."""

    @property
    def ok(self) -> bool:
        """Whether everything happened as it must."""
        return not self.broken


class Watch:
    """Follows a run tick by tick."""

    def __init__(self, expected: Expectations, words: Words | None = None) -> None:
        """Reads the conditions.

        Raises:
            ExpressionError: a condition cannot be understood.
        """

        made: dict[str, list[Expression]] = defaultdict(list)
        for path, text in expected.conditions:
            made[path[0]].append(Expression(text, words, expected._places.get(path, "")))
        self._open, self._ordered = made["eventually"], made["in_order"]
        self._always, self._at_end = made["always"], made["at_end"]
        self._broken: list[str] = []

    @property
    def finished(self) -> bool:
        """Whether further ticks cannot change the verdict."""
        return bool(self._broken) or not (self._open or self._ordered or self._always or self._at_end)

    def tick(self, time_s: float, newest: Callable[[str], Any]) -> None:
        """Takes the messages of a tick; `newest` gives the newest message of a channel.

        Raises:
            ExpressionError: a channel or a field of a condition does not exist.
        """
        self._open = [each for each in self._open if not each.holds(newest)]
        while self._ordered and self._ordered[0].holds(newest):
            del self._ordered[0]
        self._broken += [f"{time_s:.2f} s: not {each.text}" for each in self._always if not each.holds(newest)]

    def verdict(self, time_s: float, newest: Callable[[str], Any]) -> Verdict:
        """Judges the run after its last tick."""
        missed = [f"never: {each.text}" for each in (*self._open, *self._ordered[:1])]
        wrong = [f"in the end not: {each.text}" for each in self._at_end if not each.holds(newest)]
        return Verdict(time_s, self._broken + (missed + wrong if not self._broken else []))


def play(system: Any, expected: Expectations, words: Words | None = None, from_s: float = 0.0) -> Verdict:
    """Plays a scenario with a system in memory, until its time is over or its verdict is certain.

    Args:
        system: the system, before its first tick.
        expected: the conditions.
        words: functions that the conditions may use.
        from_s: logical time from which the conditions count; before, the scenario is being set up.

    Raises:
        ExpressionError: a condition cannot be understood.
    """
    watch, time_s = Watch(expected, words), 0.0
    while time_s < expected.time_s - 1e-9 and not watch.finished:
        system.tick()
        time_s = system.now_us / 1e6
        if time_s >= from_s - 1e-9:
            watch.tick(time_s, system.newest)
    return watch.verdict(time_s, system.newest)
