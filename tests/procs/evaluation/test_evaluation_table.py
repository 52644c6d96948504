"""Statistics and intervals of the table."""

import csv
import io
import json
import math
from collections.abc import Callable

import numpy as np
import pytest

from procs.evaluation.table import (
    Measure,
    Row,
    as_csv,
    as_json,
    as_text,
    mean,
    median,
    rate,
    ratio,
    rms,
    root_99,
    root_ratio,
    rows_of,
    share,
)
from procs.model.frames import Floats


@pytest.mark.parametrize(
    ("statistic", "samples", "expected"),
    [
        (rms, np.array([9.0, 16.0, 11.0]), math.sqrt(12.0)),
        (mean, np.array([1.0, 0.0, 1.0, 1.0]), 0.75),
        (median, np.array([0.1, np.inf, 0.2]), 0.2),
        (median, np.array([np.inf, np.inf, 0.2]), np.inf),
        (root_99, np.append(np.ones(100), 25.0), 1.0),
        (root_99, np.append(np.ones(50), 25.0), math.sqrt(13.0)),
        (ratio, np.array([[1.0, 2.0], [2.0, 4.0]]), 0.5),
        (root_ratio, np.array([[1.0, 4.0], [1.0, 4.0]]), 0.5),
    ],
)
def test_statistic(statistic: Callable[[Floats], float], samples: Floats, expected: float) -> None:
    assert statistic(samples) == pytest.approx(expected)


@pytest.mark.parametrize("statistic", [rms, root_99, mean, median])
def test_measure_without_samples_has_no_value(statistic: Callable[[Floats], float]) -> None:
    assert math.isnan(statistic(np.empty(0)))


@pytest.mark.parametrize("statistic", [ratio, root_ratio])
def test_ratio_without_samples_has_no_value(statistic: Callable[[Floats], float]) -> None:
    assert math.isnan(statistic(np.empty((0, 2))))


ERROR = Measure("error", rms, "m", "<= 1")


def test_interval_holds_the_spread_between_pieces() -> None:
    (row,) = rows_of([{"error": np.full(10, each)} for each in (1.0, 4.0, 9.0)], [ERROR])
    assert row.value == pytest.approx(math.sqrt(14 / 3))
    assert row.low == 0.0  # 1.0 to 3.0 if pieces are redrawn; an error is not below zero
    assert row.high == pytest.approx(row.value + 4.303 / 1.96 * math.sqrt(3 / 2) * (3.0 - row.value), abs=1e-3)
    assert row.samples == 30


def test_table_is_the_same_with_the_same_seed() -> None:
    pieces = [{"error": np.arange(each, dtype=np.float64)} for each in (3, 5, 8)]
    assert rows_of(pieces, [ERROR], seed=4) == rows_of(pieces, [ERROR], seed=4)


def test_single_piece_has_no_interval() -> None:
    rows = rows_of([{"error": np.array([4.0])}], [ERROR])
    assert as_text(rows).splitlines()[1].split() == ["error", "2.000", "1", "m", "<=", "1"]
    assert json.loads(as_json(rows))[0]["low"] is None


def test_interval_of_an_event_never_seen_ends_above_zero() -> None:
    events = Measure("event", rate, "/min", "0")
    (row,) = rows_of([{"event": np.array([(0.0, 5.0)])}, {"event": np.array([(0.0, 10.0)])}], [events])
    assert (row.value, row.low) == (0.0, 0.0)
    assert row.high == pytest.approx(0.2)  # three events in fifteen minutes
    (row,) = rows_of([{"event": np.array([(0.0, 5.0)])}, {"event": np.array([(2.0, 5.0)])}], [events])
    assert row.value == pytest.approx(0.2)


def test_json_and_csv_agree_on_what_is_no_number() -> None:
    pieces = [{"delay": np.full(3, np.inf)}, {"delay": np.full(3, 0.1)}, {"delay": np.full(3, np.inf)}]
    rows = [*rows_of(pieces, [Measure("delay", median, "s", "<= 1")]), Row("alone", -np.inf, np.nan, np.nan, 1, "", "")]
    plain = json.loads(as_json(rows), parse_constant=pytest.fail)
    table = list(csv.DictReader(io.StringIO(as_csv(rows))))
    assert [(row["value"], row["low"], row["high"]) for row in plain] == [("inf", 0.1, "inf"), ("-inf", None, None)]
    assert [(row["value"], row["low"], row["high"]) for row in table] == [("inf", "0.1", "inf"), ("-inf", "", "")]
    assert float(plain[0]["value"]) == math.inf


def test_trials_that_all_ended_alike_have_an_interval() -> None:
    """Two matches that were not won say little about how often matches are won."""
    measures = [Measure("won", share, "share", ""), Measure("known", mean, "share", "")]
    lost = {"won": np.array([0.0]), "known": np.array([1.0, 1.0])}
    won, known = rows_of([lost, lost], measures)
    assert (won.low, won.high) == pytest.approx((0.0, 0.658), abs=1e-3)
    assert (known.low, known.high) == (1.0, 1.0)
    assert rows_of([lost], measures)[0].high == pytest.approx(0.793, abs=1e-3)
    both = {"won": np.array([1.0]), "known": np.array([1.0])}
    assert [(row.low, row.high) for row in rows_of([lost, both], measures)[:1]] == [(0.0, 1.0)]


def test_pieces_with_equal_shares_have_an_interval() -> None:
    """Redrawing pieces that are alike gives an interval without width."""
    half = {"found": np.array([0.0, 1.0, 1.0, 0.0, 1.0])}
    (found,) = rows_of([half, half], [Measure("found", share, "share", "")])
    assert (found.low, found.high) == pytest.approx((0.313, 0.832), abs=1e-3)
