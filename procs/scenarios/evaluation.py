"""Evaluation of the book of scenarios for `fwk eval`: plays each scenario once with a seed, and reports all seeds."""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from fwk.testing import ExpressionError
from fwk.testing.campaign import listed
from procs.evaluation.intervals import wilson
from procs.evaluation.report_files import write_report
from procs.evaluation.table import Row, as_text
from procs.scenarios.file import BOOK, Scenario, ScenarioError
from procs.scenarios.scenario import outcome, read

INPUTS = sorted(BOOK.glob("*.yaml"))
"""Files on which results depend besides modules."""
OWN_TIME = True
"""Each scenario states how long it is played."""
ALL = "all scenarios"
"""Name of the row that counts every scenario."""


def played(_file: str, _time_s: float, seed: int) -> dict[str, list[str]]:
    """Plays every scenario of the book; returns what `played_in` does.

    Raises:
        ScenarioError: files are not scenarios.
    """
    return played_in(BOOK, seed)


def played_in(folder: Path, seed: int) -> dict[str, list[str]]:
    """Plays every scenario of a folder, each with its own system; returns the conditions that do not hold by scenario.

    The `seed` replaces that of each scenario. Each is played to its own limit of time: one that is cut off before
    would count as failed.

    Raises:
        ScenarioError: there are no files, or some are not scenarios; then none is played.
    """
    scenarios, mistakes = {}, []
    for path in sorted(folder.glob("*.yaml")):
        try:
            scenarios[path] = read(path)
        except ScenarioError as error:
            mistakes.append(str(error))
    if not scenarios and not mistakes:
        mistakes.append(f"{folder}: there are no scenarios, such as pass-is-received.yaml")
    if mistakes:
        raise ScenarioError("; ".join(mistakes))
    return {path.stem: _broken(scenario, seed) for path, scenario in scenarios.items()}


def broken_in(path: Path, seed: int) -> list[str]:
    """Plays the scenario of a file with a seed; returns the conditions that do not hold.

    Raises:
        ScenarioError: the file is not a scenario.
    """
    return _broken(read(path), seed)


def _broken(scenario: Scenario, seed: int) -> list[str]:
    try:
        return outcome(scenario.model_copy(update={"seed": seed})).broken
    except ExpressionError as error:  # a mistake that only the run shows
        raise ScenarioError(str(error)) from error
    except Exception as error:  # of a component; the other scenarios are worth a result
        return [f"{type(error).__name__}: {error}"]


def flaw_in(result: Any) -> str:
    """Returns why a result is not one of scenarios, or an empty text."""
    lists = result.values() if isinstance(result, Mapping) and result else [None]
    whole = all(isinstance(each, list) and all(isinstance(text, str) for text in each) for each in lists)
    return "" if whole else "it should hold a list of texts for each scenario"


def report(results: Sequence[Mapping[str, Sequence[str]]], folder: Path, seeds: Sequence[int] = ()) -> str:
    """Writes table.csv and table.json into the folder, and measures.png if matplotlib is there; returns the table.

    Conditions that do not hold follow the table, with those of the `seeds` of the results with which they do not.
    """
    names = sorted({name for result in results for name in result})
    outcomes = {name: [not result[name] for result in results if name in result] for name in names}
    rows = rows_of(outcomes)
    broken: dict[tuple[str, str], list[int]] = defaultdict(list)
    for place, result in enumerate(results):
        for name, text in ((name, text) for name, texts in result.items() for text in dict.fromkeys(texts)):
            broken[name, text] += seeds[place : place + 1]
    lines = [f"{name}{_with(failed)}: {text}" for (name, text), failed in sorted(broken.items())]
    return "\n".join(filter(None, (as_text(rows), *lines, write_report(rows, folder))))


def _with(seeds: Sequence[int]) -> str:
    """Returns the seeds with which a condition does not hold: `, seeds 1, 2`; empty if they are unknown."""
    return f", seed{'s' * (len(seeds) > 1)} {listed(seeds)}" if seeds else ""


def rows_of(outcomes: Mapping[str, Sequence[bool]]) -> list[Row]:
    """Returns how often all scenarios and each succeed; `outcomes` are those of each scenario."""
    every = _row(ALL, [ok for each in outcomes.values() for ok in each])
    return [every, *(_row(name, each) for name, each in outcomes.items())]


def _row(name: str, outcomes: Sequence[bool]) -> Row:
    share, (low, high) = sum(outcomes) / len(outcomes), wilson(sum(outcomes), len(outcomes))
    return Row(name, share, low, high, len(outcomes), "share", "1")
