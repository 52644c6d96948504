"""Wall times of ticks, stages and components as `fwk top` shows them: percentiles of histograms."""

from collections.abc import Mapping
from typing import Any, Literal

from fwk.display.table import Column, Table
from fwk.model.histogram import Histogram

Since = Literal["start", "now", "picture"]
TITLES = ("p50 ms", "p95 ms", "p99 ms", "max ms")
_LOOPS = ("loop", "cycle")


class Stopwatch:
    """Turns the run's histograms into figures since a moment.

    `start`: since the run, or the component, was started; `now`: since the first answer; `picture`: since the last.
    """

    def __init__(self, since: Since) -> None:
        self._since = since
        self._before: dict[str, Histogram] = {}

    def measure(self, answer: Mapping[str, Any]) -> dict[str, Any]:
        """Returns the figures of loop, cycle, stages and components, by name."""
        found = {name: Histogram.from_json(answer[name]) for name in _LOOPS}
        for kind in ("stages", "components"):
            found |= {f"{kind} {name}": Histogram.from_json(each) for name, each in answer[kind].items()}
        before = self._before
        if self._since == "picture" or (self._since == "now" and not before):
            self._before = found
        shown = {key: figures(each.since(before[key]) if key in before else each) for key, each in found.items()}
        return {
            **{name: shown[name] for name in _LOOPS},
            **{kind: {name: shown[f"{kind} {name}"] for name in answer[kind]} for kind in ("stages", "components")},
        }


def figures(times: Histogram) -> dict[str, Any]:
    """Returns figures of a histogram, in ms; `histogram` pairs the longest time of a bucket with its count."""
    return {
        "count": times.count,
        "mean_ms": times.mean_us / 1000,
        **{f"p{percent}_ms": times.percentile_us(percent) / 1000 for percent in (50, 95, 99)},
        "max_ms": times.worst_us / 1000,
        "histogram": [[longest_us / 1000, count] for longest_us, count in times.rows()],
    }


def words(times: Mapping[str, Any]) -> list[str]:
    """Returns the columns of `TITLES`."""
    return [f"{times[key]:.2f}" for key in ("p50_ms", "p95_ms", "p99_ms", "max_ms")]


def stage_table(measured: Mapping[str, Any]) -> Table:
    """Returns a table with a row for each stage, and for whole ticks."""
    table = Table("stage", *(Column(title, right=True) for title in ("runs", *TITLES)))
    for name, times in (*measured["stages"].items(), ("loop", measured["loop"]), ("cycle", measured["cycle"])):
        table.add(name, str(times["count"]), *words(times))
    return table
