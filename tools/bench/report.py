"""Writes what was measured: every run as JSON, and the tables into the generated part of docs/numbers.md."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path

from tools.bench import goals, tables
from tools.bench.figures import Run, Runs
from tools.bench.own import OwnScenario
from tools.bench.registry import Peer
from tools.bench.scenarios import Scenario

BEGIN, END = "<!-- bench: begin -->", "<!-- bench: end -->"


def write_json(path: Path, about: Mapping[str, object], runs: Sequence[Run]) -> None:
    """Writes every run with the wall time of every tick."""
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps({**about, "runs": [asdict(run) for run in runs]}, indent=1))


def read_runs(path: Path) -> list[Run]:
    """Reads back the runs of `write_json`."""
    return [Run(**run) for run in json.loads(path.read_text())["runs"]]


def text(
    about: Mapping[str, str],
    peers: Sequence[Peer],
    missing: Mapping[str, str],
    scenarios: Sequence[Scenario],
    own: Sequence[OwnScenario],
    runs: Sequence[Run],
) -> str:
    """The generated part of docs/numbers.md."""
    asked = Runs(runs)
    plain = [scenario for scenario in scenarios if scenario.is_plain]
    others = [scenario for scenario in scenarios if not scenario.is_plain]
    sizes = [scenario.shape.components for scenario in plain]
    parts = ["\n".join(f"- {key}: {value}" for key, value in about.items())]
    verdicts = goals.judge(asked, peers, sizes)
    rows = [[verdict.goal, verdict.word, verdict.figures or "-"] for verdict in verdicts]
    parts += ["## Goals", tables.markdown(["goal", "verdict", "figures"], rows)]
    if plain:
        parts += ["## A tick, by number of components", tables.tick_table(asked, peers, plain)]
    if others:
        parts += ["## Ten reads, large messages, packet loss", tables.tick_table(asked, peers, others)]
    if own:
        parts += ["## Real time", tables.jitter_table(asked, [each for each in own if each.kind == "jitter"])]
        parts += [
            "## Start, memory, restart",
            tables.start_table(asked, [each for each in own if each.kind == "start"]),
        ]
    parts.append("## What a tick costs")
    parts += [tables.cost_table(asked, peers, scenario) for scenario in scenarios]
    parts += _left_out(asked, peers, missing, scenarios, own)
    return "\n\n".join(parts)


def _left_out(
    runs: Runs,
    peers: Sequence[Peer],
    missing: Mapping[str, str],
    scenarios: Sequence[Scenario],
    own: Sequence[OwnScenario],
) -> list[str]:
    lines = [f"- {name}: {reason}" for name, reason in missing.items()]
    lines += [
        f"- {peer.title}, {scenario.name}: {error}"
        for peer in peers
        for scenario in scenarios
        for error in runs.errors(peer.name, scenario.name)
    ]
    lines += [f"- fwk, {scenario.name}: {error}" for scenario in own for error in runs.errors("fwk", scenario.name)]
    return ["## Left out or failed", "\n".join(lines) or "Nothing."]


def insert(path: Path, generated: str) -> None:
    """Replaces the generated part of a page.

    Raises:
        ValueError: the page has no such part.
    """
    page = path.read_text()
    if page.count(BEGIN) != 1 or page.count(END) != 1 or page.index(BEGIN) > page.index(END):
        raise ValueError(f"{path}: needs one line '{BEGIN}' and after it one line '{END}'")
    before, after = page[: page.index(BEGIN)], page[page.index(END) :]
    path.write_text(f"{before}{BEGIN}\n\n{generated}\n\n{after}")
