"""Shows that the simulation finds every mutation: `python -m tests.simulation.find_mutations`."""

import argparse
import multiprocessing
import os
import sys

from tests.simulation.checks import verdict_of
from tests.simulation.mutations import MUTATIONS
from tests.simulation.scenario import scenario_of

_MODULE = "tests/simulation/mutations.py"
Found = tuple[str, int, str]
"""Mutation, seed that found it (0: none did) and the failure."""


def _find(task: tuple[int, int]) -> Found:
    return find(*task)


def find(number: int, histories: int) -> Found:
    """Returns the first seed that finds a mutation."""
    mutation = MUTATIONS[number]
    with mutation.applied():
        for seed in range(1, histories + 1):
            failures = verdict_of(scenario_of(seed)).failures
            if failures:
                if _MODULE in str(failures[0]):  # the mutation raises by itself, which proves nothing
                    raise RuntimeError(f"the mutation '{mutation.name}' does not fit the engine: {failures[0]}")
                return mutation.name, seed, str(failures[0])
    return mutation.name, 0, f"not found: {mutation.breaks}"


def main() -> int:
    """Searches for all mutations; returns the exit code."""
    parser = argparse.ArgumentParser(description="Breaks the contract on purpose and shows that histories find it.")
    parser.add_argument("--histories", type=int, default=1000, help="most histories for a mutation; default 1000")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="default: one a processor")
    words = parser.parse_args()
    missed = 0
    with multiprocessing.get_context("fork").Pool(words.processes, maxtasksperchild=1) as pool:
        tasks = [(number, words.histories) for number in range(len(MUTATIONS))]
        for name, seed, text in pool.imap(_find, tasks):
            missed += not seed
            print(f"{name:<20} {f'SEED={seed}' if seed else 'MISSED':<10} {text.splitlines()[0][:120]}", flush=True)
    print(f"{len(MUTATIONS) - missed} of {len(MUTATIONS)} mutations found")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
