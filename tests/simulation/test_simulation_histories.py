"""Histories of simulated systems: a share of `make simulate`, and those that once broke a promise."""

import pytest

from tests.simulation.checks import verdict_of
from tests.simulation.find_mutations import find
from tests.simulation.mutations import MUTATIONS
from tests.simulation.regressions import REGRESSIONS
from tests.simulation.scenario import Scenario, scenario_of

HISTORIES = 8
"""In one test."""
FIRST = range(1, 1 + 5 * HISTORIES, HISTORIES)
QUICK = 1
"""Number of these tests in `make test-fast`."""


def broken(scenario: Scenario) -> list[str]:
    """Returns the promises that a history breaks, in words."""
    return [str(failure) for failure in verdict_of(scenario).failures]


@pytest.mark.parametrize(
    "first", [*FIRST[:QUICK], *(pytest.param(each, marks=pytest.mark.slow) for each in FIRST[QUICK:])]
)
def test_histories_keep_every_promise(first: int) -> None:
    found = {seed: broken(scenario_of(seed)) for seed in range(first, first + HISTORIES)}
    assert {seed: failures for seed, failures in found.items() if failures} == {}


@pytest.mark.parametrize("name", REGRESSIONS)
def test_a_promise_once_broken_is_kept(name: str) -> None:
    assert broken(REGRESSIONS[name]) == []


@pytest.mark.parametrize("name", ["early marks", "sequence restarts", "repeated tick runs", "fetch unanswered"])
def test_a_broken_contract_is_found(name: str) -> None:
    number = [mutation.name for mutation in MUTATIONS].index(name)
    _, seed, failure = find(number, histories=10)
    assert seed, failure
