"""The table of an evaluation: each measure with its interval, beside its goal."""

import csv
import io
import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, fields
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from procs.evaluation.beliefs import AVERAGE, PARTICLES, Samples
from procs.evaluation.intervals import Interval, difference, never, poisson, widened, wilson
from procs.model.frames import Floats

_REDRAWS = 1000
_FEW = 10  # fewer events than that tell too little about their number in other pieces


def rms(samples: Floats) -> float:
    """Returns the root of the mean of squared errors (n)."""
    return float(np.sqrt(np.mean(samples))) if len(samples) else np.nan


def root_99(samples: Floats) -> float:
    """Returns the root of the 99th percentile of squared errors (n)."""
    return float(np.sqrt(_quantile(samples, 0.99))) if len(samples) else np.nan


def high_95(samples: Floats) -> float:
    """Returns the 95th percentile of samples (n)."""
    return _quantile(samples, 0.95) if len(samples) else np.nan


def _quantile(samples: Floats, share: float) -> float:
    """Returns a quantile of samples (n); between infinite ones nothing is interpolated."""
    return float(np.quantile(samples, share, method="inverted_cdf" if np.isinf(samples).any() else "linear"))


def mean(samples: Floats) -> float:
    """Returns the mean of samples (n)."""
    return float(np.mean(samples)) if len(samples) else np.nan


def share(samples: Floats) -> float:
    """Share of the trials (n) that succeeded: each is 1 or 0, and tells as much as the others."""
    return mean(samples)


def frequency(samples: Floats) -> float:
    """Returns the mean number of events in a frame or a belief (n)."""
    return mean(samples)


def median(samples: Floats) -> float:
    """Returns the median of samples (n), infinite ones among them."""
    return float(np.quantile(samples, 0.5, method="inverted_cdf")) if len(samples) else np.nan


def ratio(samples: Floats) -> float:
    """Returns the sum of the first column by the sum of the second (n, 2)."""
    below = samples[:, 1].sum() if len(samples) else 0.0
    return float(samples[:, 0].sum() / below) if below else np.nan


def rate(samples: Floats) -> float:
    """Returns the number of events, the first column, by the time in which they happened, the second (n, 2)."""
    return ratio(samples)


def root_ratio(samples: Floats) -> float:
    """Returns the ratio of two root mean squares whose squares are the columns (n, 2)."""
    return float(np.sqrt(ratio(samples)))


@dataclass(frozen=True)
class Measure:
    """A row of the table."""

    name: str
    statistic: Callable[[Floats], float]
    unit: str
    goal: str
    """The value to reach, in the same unit; empty without one."""
    rates: tuple[str, str] | None = None
    """Names of the two measures whose difference it is."""

    @property
    def possible(self) -> Interval:
        """Limits of all values: shares are parts of 1, and only ratios may be negative."""
        return -np.inf if self.statistic is ratio else 0.0, 1.0 if self.unit == "share" else np.inf


MEASURES = [
    Measure("ball known", mean, "share", ">= 0.95"),
    Measure("ball known to a robot of the team", mean, "share", ">= 0.95"),
    Measure("ball lost, until known again", median, "s", "<= 0.5"),
    Measure("ball moving, position", rms, "m", ""),
    Measure("ball moving, velocity", rms, "m/s", ""),
    Measure("ball rolling freely, position", rms, "m", "<= 0.05"),
    Measure("ball rolling freely, velocity", rms, "m/s", "<= 0.15"),
    Measure("ball in the air, position", rms, "m", ""),
    Measure("ball in the air, velocity", rms, "m/s", ""),
    Measure("ball in the air, height", rms, "m", ""),
    Measure("ball resting, position", rms, "m", "<= 0.03"),
    Measure("ball resting, velocity", rms, "m/s", "<= 0.05"),
    Measure("ball found in a frame, up to 2.5 m", mean, "share", ">= 0.90"),
    Measure("ball found in a frame, 2.5 to 5 m", mean, "share", ">= 0.90"),
    Measure("ball found in a frame, 5 to 7.5 m", mean, "share", ""),
    Measure("balls that do not exist, a frame", frequency, "", "<= 0.0005"),
    Measure("one sighting, ball resting", rms, "m", ""),
    Measure("one sighting, ball moving", rms, "m", ""),
    Measure("fused to best single", root_ratio, "", "<= 0.5"),
    Measure("fused to best single at its exposure", root_ratio, "", "<= 1"),
    Measure("fused to median robot", root_ratio, "", "<= 0.5"),
    Measure("fused to plain average", root_ratio, "", "<= 0.8"),
    Measure("ball, squared error by its covariance", mean, "", "2"),
    Measure("ball innovations, correlation of successive", ratio, "", ""),
    Measure("inside 95 %, all", mean, "share", "0.90-0.99"),
    Measure("inside 95 %, rolling freely", mean, "share", "0.90-0.99"),
    Measure("inside 95 %, resting", mean, "share", "0.90-0.99"),
    Measure("inside 95 %, held by another", mean, "share", "0.90-0.99"),
    Measure("inside 95 %, held by itself", mean, "share", "0.90-0.99"),
    Measure("inside 95 %, ball unseen", mean, "share", ""),
    Measure("inside 95 %, opponents", mean, "share", ""),
    Measure("inside 95 %, mates", mean, "share", ""),
    Measure("velocity known after a kick", median, "s", "<= 0.10"),
    Measure("velocity known after an own kick", median, "s", "<= 0.10"),
    Measure("opponents, position", rms, "m", "<= 0.08"),
    Measure("opponents, lag", ratio, "s", "0"),
    Measure("opponents known", mean, "share", ">= 0.80"),
    Measure("opponents that do not exist", frequency, "share", ""),
    Measure("pose known", mean, "share", ""),
    Measure("pose, position", rms, "m", "<= 0.10"),
    Measure("pose, position, 99 %", root_99, "m", "<= 0.30"),
    Measure("pose, heading", rms, "rad", "<= 0.03"),
    Measure("pose, robot stands, position", rms, "m", "<= 0.03"),
    Measure("pose, robot stands, heading", rms, "rad", "<= 0.02"),
    Measure("picture to motion of the wheels, 95 %", high_95, "s", ""),
    Measure("radio, age of a mate's newest message, 95 %", high_95, "s", "<= 0.12"),
    Measure("radio, messages of a robot", ratio, "/s", "10"),
    Measure("radio, volume of a team", ratio, "Mbit/s", "<= 2.2"),
    Measure("wrong pose believed", rate, "/1000 min", "0"),
    Measure("pose jumps", rate, "/min", "<= 0.05"),
    Measure("kidnapped, found within 10 s", share, "share", ">= 0.99"),
    Measure("kidnapped, time until found", median, "s", "<= 2"),
    Measure(f"{PARTICLES}pose known", mean, "share", ""),
    Measure(f"{PARTICLES}pose, position", rms, "m", ""),
    Measure(f"{PARTICLES}pose, position, 99 %", root_99, "m", ""),
    Measure(f"{PARTICLES}pose, heading", rms, "rad", ""),
    Measure(f"{PARTICLES}pose, robot stands, position", rms, "m", ""),
    Measure(f"{PARTICLES}pose, robot stands, heading", rms, "rad", ""),
    Measure(f"{PARTICLES}wrong pose believed", rate, "/1000 min", ""),
    Measure(f"{PARTICLES}pose jumps", rate, "/min", ""),
    Measure(f"{PARTICLES}kidnapped, found within 10 s", share, "share", ""),
    Measure(f"{PARTICLES}kidnapped, time until found", median, "s", ""),
    Measure(f"{AVERAGE}ball moving, position", rms, "m", ""),
    Measure(f"{AVERAGE}ball rolling freely, position", rms, "m", ""),
    Measure(f"{AVERAGE}ball resting, position", rms, "m", ""),
    Measure("collisions above 1 m/s", rate, "/min", "<= 1"),
    Measure("collisions above 3 m/s", rate, "/min", "0"),
    Measure("distance violated at restarts", share, "share", "0"),
    Measure("half violated at kick-offs", share, "share", "0"),
    Measure("restarts taken within 7 s", share, "share", ">= 0.95"),
    Measure("role changes of a field player", rate, "/min", ""),
    Measure("passes controlled by the receiver", share, "share", ">= 0.80"),
    Measure("captures that bounce", share, "share", ""),
    Measure("ball free", mean, "share", ""),
    Measure("shots", rate, "/min", ""),
    Measure("goals", rate, "/min", ""),
    Measure("goals of cyan", rate, "/min", ""),
    Measure("goals of magenta", rate, "/min", ""),
    Measure("goals of cyan less those of magenta", ratio, "/min", "", ("goals of cyan", "goals of magenta")),
    Measure("won by cyan", share, "share", ""),
    Measure("lost by cyan", share, "share", ""),
]
"""Rows of the table in their order."""


@dataclass(frozen=True)
class Row:
    """A measure over all pieces, with the interval that holds the value with a probability of 95 %."""

    name: str
    value: float
    low: float
    high: float
    samples: int
    unit: str
    goal: str


def rows_of(pieces: Sequence[Samples], measures: Sequence[Measure] = MEASURES, seed: int = 1) -> list[Row]:
    """Computes the table; the interval comes from redrawing whole pieces, as samples of a piece depend on each other.

    As few pieces redrawn vary less than pieces do, the interval is widened. The interval of events that were never seen
    ends at the rate with which seeing none has a probability of 5 %. Where redrawing gives no width, trials have
    Wilson's interval, as do those that all ended alike, and rates of events, and differences of two, that of Poisson's
    distribution; that of fewer than ten events, or trials of the rarer end, holds theirs at least. A single piece gives
    an interval of events never seen and of trials that all ended alike; otherwise its limits are NaN.
    """
    rng = np.random.default_rng(seed)
    draws = rng.integers(len(pieces), size=(_REDRAWS, len(pieces)))
    rows = []
    for measure in measures:
        samples = [piece[measure.name] for piece in pieces]
        value, count = measure.statistic(np.concatenate(samples)), sum(map(len, samples))
        low, high = _interval(measure, value, pieces, draws)
        rows.append(Row(measure.name, value, low, high, count, measure.unit, measure.goal))
    return rows


def _interval(measure: Measure, value: float, pieces: Sequence[Samples], draws: NDArray[np.int64]) -> Interval:
    samples = [piece[measure.name] for piece in pieces]
    drawn = _redrawn(measure, samples, draws) if len(pieces) > 1 else (np.nan, np.nan)
    even, counted = drawn[0] == drawn[1], sum(not np.isnan(measure.statistic(each)) for each in samples)
    single = _of_single_events(measure, samples, pieces)
    if single and (even or single.events == 0):
        return single.interval
    if counted < 2 or (measure.rates and even):  # a result of former code has a difference without its rates
        return np.nan, np.nan
    low, high = widened(value, drawn, counted, measure.possible)
    if single and single.events < _FEW:
        return min(low, single.interval[0]), max(high, single.interval[1])
    return low, high


class _SingleEvents(NamedTuple):
    """Interval of trials or events as if none depended on another, whatever their pieces."""

    interval: Interval
    events: float
    """How many events there were, or trials that ended one way, the rarer one."""


def _of_single_events(measure: Measure, samples: Sequence[Floats], pieces: Sequence[Samples]) -> _SingleEvents | None:
    """Returns the interval of trials, of rates of events, or of a difference of two; None for other measures."""
    if measure.rates:
        (events, time), (others, _) = (_counted([piece[each] for piece in pieces]) for each in measure.rates)
        return _SingleEvents(difference(events, others, time), events + others or 1.0) if time else None
    events, time = _counted(samples) if measure.statistic in (share, rate, frequency) else (0.0, 0.0)
    if not time:
        return None
    if measure.statistic is share:
        return _SingleEvents(wilson(round(events), round(time)), min(events, time - events))
    low, high = poisson(events, time) if events else never(time)
    return _SingleEvents((low, min(high, measure.possible[1])), events)


def _redrawn(measure: Measure, samples: Sequence[Floats], draws: NDArray[np.int64]) -> Interval:
    """Returns the limits between which 95 % of the values of redrawn pieces lie; NaN if none has a value."""
    values = [measure.statistic(np.concatenate([samples[index] for index in draw])) for draw in draws]
    sound = [each for each in values if not np.isnan(each)]
    if not sound:
        return np.nan, np.nan
    low, high = np.quantile(sound, (0.025, 0.975), method="inverted_cdf").tolist()
    return low, high


def _counted(samples: Sequence[Floats]) -> tuple[float, float]:
    """Returns how many events there were, and for how long they could happen: the sums of both columns.

    Samples without a second column each count as long as the others.
    """
    every = np.concatenate(samples)
    events, time = every.sum(axis=0).tolist() if every.ndim > 1 else (float(every.sum()), float(len(every)))
    return events, time


def as_text(rows: Sequence[Row]) -> str:
    """Returns the table for people."""
    width = max((len(row.name) for row in rows), default=0)
    lines = [f"{'measure':{width}} {'value':>9} {'95 % interval':>19} {'samples':>8}  {'unit':9} goal"]
    for row in rows:
        interval = "" if np.isnan(row.low) else f"{row.low:.3f} .. {row.high:.3f}"
        lines.append(
            f"{row.name:{width}} {row.value:9.3f} {interval:>19} {row.samples:8d}  {row.unit:9} {row.goal}".rstrip()
        )
    return "\n".join(lines)


def as_csv(rows: Sequence[Row]) -> str:
    """Returns the table for spreadsheets; the first line names the columns, infinity is `inf`, no number empty."""
    text = io.StringIO()
    writer = csv.DictWriter(text, [each.name for each in fields(Row)], lineterminator="\n")
    writer.writeheader()
    writer.writerows({key: "" if value is None else value for key, value in each.items()} for each in _plain(rows))
    return text.getvalue()


def as_json(rows: Sequence[Row]) -> str:
    """Returns the table for programs; JSON has no infinity, which is the text "inf"; no number is null."""
    return json.dumps(_plain(rows), indent=1, allow_nan=False)


def _plain(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Returns the rows with values that files can hold: infinity as text, and None for no number."""
    return [{key: _told(value) for key, value in asdict(row).items()} for row in rows]


def _told(value: Any) -> Any:
    if not isinstance(value, float) or np.isfinite(value):
        return value
    return None if np.isnan(value) else str(value)
