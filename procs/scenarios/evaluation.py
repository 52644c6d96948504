"""Evaluation of the book of scenarios for `fwk eval`: plays each scenario once with a seed, and reports all seeds."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fwk.testing.executors import INSTALL
from procs.evaluation.intervals import wilson
from procs.evaluation.plots import plot
from procs.evaluation.table import Row, as_csv, as_json, as_text
from procs.scenarios.file import BOOK
from procs.scenarios.scenario import outcome, read

INPUTS = sorted(BOOK.glob("*.yaml"))
"""Files on which results depend besides modules."""
ALL = "all scenarios"
"""Name of the row that counts every scenario."""


def played(_file: str, _time_s: float, seed: int) -> dict[str, list[str]]:
    """Plays every scenario of the book, each with its own system; returns the conditions that do not hold by scenario.

    The `seed` replaces that of each scenario. Each is played to its own limit of time: one that is cut off before
    would count as failed.
    """
    return {path.stem: broken_in(path, seed) for path in sorted(BOOK.glob("*.yaml"))}


def broken_in(path: Path, seed: int) -> list[str]:
    """Plays the scenario of a file with a seed; returns the conditions that do not hold.

    A component that fails counts as one: the other scenarios are worth a result.
    """
    try:
        return outcome(read(path).model_copy(update={"seed": seed})).broken
    except Exception as error:
        return [f"{type(error).__name__}: {error}"]


def flaw_in(result: Any) -> str:
    """Returns why a result is not one of scenarios, or an empty text."""
    lists = result.values() if isinstance(result, Mapping) else [None]
    whole = all(isinstance(each, list) and all(isinstance(text, str) for text in each) for each in lists)
    return "" if whole else "it should hold a list of texts for each scenario"


def report(results: Sequence[Mapping[str, Sequence[str]]], folder: Path) -> str:
    """Writes table.csv and table.json into the folder, and measures.png if matplotlib is there; returns the table."""
    names = sorted({name for result in results for name in result})
    outcomes = {name: [not result[name] for result in results if name in result] for name in names}
    rows = rows_of(outcomes)
    (folder / "table.csv").write_text(as_csv(rows))
    (folder / "table.json").write_text(as_json(rows))
    broken = sorted({f"{name}: {text}" for result in results for name, texts in result.items() for text in texts})
    text = "\n".join([as_text(rows), *broken])
    try:
        plot(rows, folder / "measures.png")
    except ImportError:
        return f"{text}\nno picture: matplotlib is not installed; type: {INSTALL}"
    return text


def rows_of(outcomes: Mapping[str, Sequence[bool]]) -> list[Row]:
    """Returns how often all scenarios and each succeed; `outcomes` are those of each scenario."""
    every = _row(ALL, [ok for each in outcomes.values() for ok in each])
    return [every, *(_row(name, each) for name, each in outcomes.items())]


def _row(name: str, outcomes: Sequence[bool]) -> Row:
    share, (low, high) = sum(outcomes) / len(outcomes), wilson(sum(outcomes), len(outcomes))
    return Row(name, share, low, high, len(outcomes), "share", "1")
