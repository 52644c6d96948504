"""Simulates many histories: `python -m tests.simulation --help`."""

import argparse
import multiprocessing
import os
import sys
from collections import Counter
from dataclasses import dataclass
from pprint import pformat

from fwk.clock import US_PER_S, monotonic_us
from tests.simulation.checks import Verdict, trace_of, verdict_of
from tests.simulation.scenario import Scenario, scenario_of
from tests.simulation.shrink import shrink
from tests.simulation.world import START_US

_FAILURES_MAX = 5


@dataclass
class Summary:
    """Figures of all histories so far."""

    histories: int = 0
    runs: int = 0
    ticks: int = 0
    wall_us: int = 0
    events: int = 0

    def add(self, verdict: Verdict) -> None:
        """Adds a history."""
        self.histories += 1
        self.runs += verdict.runs
        self.ticks += verdict.ticks
        self.wall_us += verdict.wall_us
        self.events += verdict.events


def main() -> int:
    """Simulates histories; returns the exit code."""
    parser = argparse.ArgumentParser(description="Simulates whole systems with faults, each history from a seed.")
    parser.add_argument("--histories", type=int, default=1000, help="how many; default 1000")
    parser.add_argument("--seconds", type=float, default=0.0, help="end after so much time; 0: when all are done")
    parser.add_argument("--first", type=int, default=1, help="first seed; default 1")
    parser.add_argument("--seed", type=int, help="show this history step by step")
    parser.add_argument("--processes", type=int, default=os.cpu_count() or 1, help="default: one a processor")
    parser.add_argument("--no-shrink", action="store_true", help="report a failing history as it is")
    words = parser.parse_args()
    if words.seed is not None:
        return _show(words.seed, not words.no_shrink)
    return _many(words.first, words.histories, words.seconds, words.processes, not words.no_shrink)


def _verdict(seed: int) -> tuple[int, Verdict]:
    try:
        return seed, verdict_of(scenario_of(seed))
    except Exception as error:
        raise RuntimeError(f"SEED={seed}: the simulation itself fails") from error


def _many(first: int, histories: int, seconds: float, processes: int, shrinks: bool) -> int:
    began_us = monotonic_us()
    summary, failed = Summary(), []
    kinds: Counter[str] = Counter()
    with multiprocessing.get_context("fork").Pool(processes, maxtasksperchild=200) as pool:
        for seed, verdict in pool.imap_unordered(_verdict, range(first, first + histories)):
            summary.add(verdict)
            if verdict.failures:
                failed.append(seed)
                kinds[verdict.failures[0].promise] += 1
                print(f"SEED={seed} {verdict.failures[0]}", flush=True)
            if seconds and monotonic_us() - began_us > seconds * US_PER_S:
                pool.terminate()
                break
    wall_s = (monotonic_us() - began_us) / US_PER_S
    print(
        f"{summary.histories} histories ({summary.runs} runs, {summary.ticks} ticks, "
        f"{summary.wall_us / US_PER_S:.0f} simulated seconds, {summary.events} events) in {wall_s:.0f} s: "
        f"{len(failed)} failed {dict(kinds) if kinds else ''}"
    )
    if failed and shrinks:
        _report(min(failed))
    return 1 if failed else 0


def _report(seed: int) -> None:
    smallest, verdict = _shrunk(scenario_of(seed))
    print(f"\nThe smallest history like that of SEED={seed}:\n{pformat(smallest, width=110)}")
    print(verdict.failures[0] if verdict.failures else "passes")
    print(f"make simulate SEED={seed} shows it step by step")


def _show(seed: int, shrinks: bool) -> int:
    scenario = scenario_of(seed)
    verdict = verdict_of(scenario)
    if verdict.failures and shrinks:
        scenario, verdict = _shrunk(scenario)
    for line in trace_of(scenario).lines(START_US):
        print(line)
    print(pformat(scenario, width=110))
    for failure in verdict.failures:
        print(f"FAILS {failure}")
    return 1 if verdict.failures else 0


def _shrunk(scenario: Scenario) -> tuple[Scenario, Verdict]:
    promise = verdict_of(scenario).failures[0].promise

    def fails(candidate: Scenario) -> bool:
        return any(failure.promise == promise for failure in verdict_of(candidate).failures)

    smallest = shrink(scenario, fails)
    return smallest, verdict_of(smallest)


if __name__ == "__main__":
    sys.exit(main())
