"""The tables of a benchmark, and their place in docs/numbers.md."""

import re
from pathlib import Path

from tools.bench import goals, tables
from tools.bench.figures import Runs
from tools.bench.own import LONG
from tools.bench.record import Record

_COLOURS = re.compile(r"\x1b\[[0-9;]*m")
_FOLDERS = re.compile(r"(?<![\w.])(?:/[\w.+-]+)+?(?=/build/|/bench-)")  # of one machine, before what is the same on all
BEGIN, END = "<!-- bench: begin -->", "<!-- bench: end -->"


def text(record: Record) -> str:
    """The generated part of docs/numbers.md."""
    asked, peers, scenarios, own = Runs(record.runs), record.peers, record.scenarios, record.own
    plain = [scenario for scenario in scenarios if scenario.is_plain]
    others = [scenario for scenario in scenarios if not scenario.is_plain]
    sizes = [scenario.shape.components for scenario in plain]
    parts = ["\n".join(f"- {key}: {value}" for key, value in record.about.items())]
    verdicts = goals.judge(asked, peers, sizes)
    rows = [[verdict.goal, verdict.word, verdict.figures or "-"] for verdict in verdicts]
    parts += ["## Goals", tables.markdown(["goal", "verdict", "figures"], rows)]
    if plain:
        parts += ["## A tick, by number of components", tables.tick_table(asked, peers, plain)]
    if others:
        parts += ["## Ten reads, large messages, packet loss", tables.tick_table(asked, peers, others)]
    if own:
        parts += ["## Real time", tables.jitter_table(asked, [*(each for each in own if each.kind == "jitter"), *LONG])]
        parts += [
            "## Start, memory, restart",
            tables.start_table(asked, [each for each in own if each.kind == "start"]),
        ]
    parts.append("## What a tick costs")
    parts += [tables.cost_table(asked, peers, scenario) for scenario in scenarios]
    parts += _left_out(record)
    return "\n\n".join(parts)


def _left_out(record: Record) -> list[str]:
    runs = Runs(record.runs)
    lines = [f"- {name}: {reason}" for name, reason in record.missing.items()]
    lines += [
        f"- {peer.title}, {scenario.name}: {_plain(error)}"
        for peer in record.peers
        for scenario in record.scenarios
        for error in runs.errors(peer.name, scenario.name)
    ]
    lines += [
        f"- fwk, {scenario.name}: {_plain(error)}"
        for scenario in record.own
        for error in runs.errors("fwk", scenario.name)
    ]
    return ["## Left out or failed", "\n".join(lines) or "Nothing."]


def _plain(error: str) -> str:
    """Returns an error without colours, and without the folders of the machine."""
    return _FOLDERS.sub("...", _COLOURS.sub("", error))


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
