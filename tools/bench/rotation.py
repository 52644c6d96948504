"""Runs all peers in rotation, once a round in every arrangement, so that a slow hour affects all alike."""

import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, replace

from tools.bench import namespace
from tools.bench.environments import CORE, REPOSITORY
from tools.bench.figures import Run
from tools.bench.own import OwnScenario
from tools.bench.registry import Peer
from tools.bench.scenarios import Scenario

_RUN_S = 150.0
_FIRST_PORT = 20_000
_PORTS_A_RUN = 700


def isolation() -> list[str]:
    """Returns words that run a command in a namespace; none where that is not permitted: then ports differ."""
    try:
        return namespace.command()
    except namespace.NoNamespaceError:
        return []


def rotate(
    peers: Sequence[Peer],
    scenarios: Sequence[Scenario],
    rounds: int,
    seconds: float,
    report: Callable[[Run], None],
) -> list[Run]:
    """Measures every peer in every scenario `rounds` times; peers change places from round to round.

    A run takes `seconds` at most, start-up and end not counted. Each run goes to `report` when it ends. A peer that
    failed an arrangement in two rounds is not tried there again.
    """
    runs: list[Run] = []
    words = isolation()
    for number in range(rounds):
        for scenario in scenarios:
            shift = number % max(1, len(peers))
            for peer in [*peers[shift:], *peers[:shift]]:
                failed = [run for run in runs if run.error and (run.peer, run.scenario) == (peer.name, scenario.name)]
                if len(failed) < 2:
                    run = Run(number, peer.name, scenario.name, _run(words, len(runs), peer, scenario, seconds))
                    runs.append(run)
                    report(run)
    return runs


def rotate_own(
    scenarios: Sequence[OwnScenario], rounds: int, seconds: float, report: Callable[[Run], None]
) -> list[Run]:
    """Measures the arrangements of fwk alone, each once a round."""
    runs = []
    words = isolation()
    for number in range(rounds):
        for scenario in scenarios:
            job = {**scenario.job(seconds), "isolated": bool(words)}
            run = Run(number, "fwk", scenario.name, _result([*words, *_module("own_driver"), json.dumps(job)], seconds))
            runs.append(run)
            report(run)
    return runs


def _run(words: list[str], number: int, peer: Peer, scenario: Scenario, seconds: float) -> dict[str, object]:
    shape = scenario.shape
    if not words:
        shape = replace(shape, base_port=_FIRST_PORT + number % 50 * _PORTS_A_RUN)
    job = {
        "peer": peer.name,
        "shape": asdict(shape),
        "loss": scenario.loss,
        "ticks": scenario.ticks,
        "seconds": seconds,
        "isolated": bool(words),
    }
    return _result([*words, *_module("driver"), json.dumps(job)], seconds)


def _module(name: str) -> list[str]:
    return [sys.executable, "-m", f"tools.bench.{name}"]


def _result(command: list[str], seconds: float) -> dict[str, object]:
    try:
        done = subprocess.run(
            command,
            env=CORE.process_variables(),
            cwd=REPOSITORY,
            capture_output=True,
            text=True,
            timeout=_RUN_S + seconds,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return {"error": f"nothing within {_RUN_S + seconds:.0f} s"}
    if done.returncode or not done.stdout.strip():
        return {"error": (done.stderr.strip().splitlines() or ["the driver wrote nothing"])[-1]}
    result: dict[str, object] = json.loads(done.stdout.splitlines()[-1])
    return result
