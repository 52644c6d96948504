"""From single runs to published figures: medians over rounds, their spread, and ratios within a round."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any


@dataclass(frozen=True)
class Spread:
    """A figure measured in several rounds."""

    middle: float
    low: float
    high: float
    rounds: int

    @classmethod
    def of(cls, values: Sequence[float]) -> "Spread":
        """Returns median, smallest and largest of `values`.

        Raises:
            ValueError: there are none.
        """
        if not values:
            raise ValueError("no round gave a value")
        return cls(median(values), min(values), max(values), len(values))


def percentile(values: Sequence[float], share: float) -> float:
    """Returns the smallest value that at least a share of all (0 to 1) does not exceed; nearest rank.

    Raises:
        ValueError: there are no values, or the share is outside 0 to 1.
    """
    if not values or not 0 <= share <= 1:
        raise ValueError(f"no percentile {share} of {len(values)} values")
    ranked = sorted(values)
    return ranked[max(0, -(-int(share * 1_000_000) * len(ranked) // 1_000_000) - 1)]


@dataclass(frozen=True)
class Run:
    """One run in one round: figures, or the error that prevented them."""

    round: int
    peer: str
    scenario: str
    result: dict[str, Any]

    @property
    def error(self) -> str:
        """Reason for missing figures; empty if there are some."""
        return str(self.result.get("error", ""))


class Runs:
    """All runs of a benchmark, by peer and scenario."""

    def __init__(self, runs: Sequence[Run]) -> None:
        self._runs: dict[tuple[str, str], list[Run]] = {}
        for run in runs:
            self._runs.setdefault((run.peer, run.scenario), []).append(run)

    def of(self, peer: str, scenario: str) -> list[Run]:
        """Returns the runs that gave figures."""
        return [run for run in self._runs.get((peer, scenario), []) if not run.error]

    def errors(self, peer: str, scenario: str) -> list[str]:
        """Returns the errors, once each."""
        return list(dict.fromkeys(run.error for run in self._runs.get((peer, scenario), []) if run.error))

    def spread(self, peer: str, scenario: str, figure: Callable[[dict[str, Any]], float | None]) -> Spread | None:
        """Returns a figure over the rounds; None if no round has it."""
        values = [value for run in self.of(peer, scenario) if (value := figure(run.result)) is not None]
        return Spread.of(values) if values else None

    def ratio(self, peer: str, other: str, scenario: str, other_scenario: str = "") -> Spread | None:
        """Returns the ratio of the median tick times of `peer` and `other`, within each round; None without a pair.

        `other_scenario` compares with another arrangement than `scenario`.
        """
        base = {run.round: tick_us(run.result) for run in self.of(other, other_scenario or scenario)}
        ratios = [tick_us(run.result) / base[run.round] for run in self.of(peer, scenario) if base.get(run.round)]
        return Spread.of(ratios) if ratios else None


def tick_us(result: dict[str, Any]) -> float:
    """Returns the median wall time of a tick of one run in µs."""
    return float(median(result["tick_us"]))


def tick_mean_us(result: dict[str, Any]) -> float:
    """Returns the mean wall time of a tick of one run in µs; under losses the median would hide the waits."""
    return float(sum(result["tick_us"]) / len(result["tick_us"]))


def error_us(result: dict[str, Any], share: float) -> float:
    """Returns a percentile (0 to 1) of the deviation of periods from the desired one, of one run in µs."""
    return percentile(result["error_us"], share)


def tick_p99_us(result: dict[str, Any]) -> float:
    """Returns the 99th percentile of the tick's wall time of one run in µs."""
    return percentile(result["tick_us"], 0.99)
