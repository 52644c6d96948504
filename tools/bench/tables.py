"""Markdown tables of the figures."""

from collections.abc import Sequence
from typing import Any

from tools.bench.figures import Runs, Spread, error_us, tick_mean_us, tick_p99_us, tick_us
from tools.bench.own import OwnScenario
from tools.bench.registry import Peer
from tools.bench.scenarios import Scenario

REFERENCE = "lcm"
"""Reference peer of all ratios."""

Row = Sequence[str]


def markdown(header: Row, rows: Sequence[Row]) -> str:
    """Returns a table, first column to the left, others to the right."""
    rule = ["---", *["---:"] * (len(header) - 1)]
    return "\n".join(
        "| " + " | ".join(cell.replace("|", "\\|") for cell in row) + " |" for row in [header, rule, *rows]
    )


def milliseconds(spread: Spread | None) -> str:
    """Returns the median and, in brackets, smallest and largest of the rounds: `1.52 (1.48-1.71)`."""
    if spread is None:
        return "-"
    return f"{_number(spread.middle / 1000)} ({_number(spread.low / 1000)}-{_number(spread.high / 1000)})"


def _number(value: float) -> str:
    return f"{value:.2f}" if value < 10 else f"{value:.1f}" if value < 100 else f"{value:.0f}"


def tick_table(runs: Runs, peers: Sequence[Peer], scenarios: Sequence[Scenario]) -> str:
    """Returns wall times of a tick and ratios to the reference, one row a peer, one column an arrangement.

    Under packet loss it gives the mean, because a median hides rare events.
    """
    rows = [[peer.title, *(_tick_cell(runs, peer.name, scenario) for scenario in scenarios)] for peer in peers]
    return markdown(["tick, ms", *(scenario.name for scenario in scenarios)], rows)


def _tick_cell(runs: Runs, peer: str, scenario: Scenario) -> str:
    spread = runs.spread(peer, scenario.name, tick_mean_us if scenario.loss else tick_us)
    if spread is None:
        return "failed" if runs.errors(peer, scenario.name) else "-"
    ratio = runs.ratio(peer, REFERENCE, scenario.name)
    return milliseconds(spread) + ("" if ratio is None or scenario.loss else f" x{ratio.middle:.2f}")


def cost_table(runs: Runs, peers: Sequence[Peer], scenario: Scenario) -> str:
    """Returns the costs of a tick besides wall time, one row a peer, for one arrangement."""

    def middle(peer: str, key: str, form: str) -> str:
        spread = runs.spread(peer, scenario.name, lambda result: _value(result, key))
        return "-" if spread is None else format(spread.middle, "z" + form)

    rows = []
    for peer in peers:
        if not runs.of(peer.name, scenario.name):
            continue
        rows.append(
            [
                peer.title,
                milliseconds(runs.spread(peer.name, scenario.name, tick_us)),
                milliseconds(runs.spread(peer.name, scenario.name, tick_p99_us)),
                milliseconds(runs.spread(peer.name, scenario.name, _cpu_us)),
                middle(peer.name, "switches", ".0f"),
                middle(peer.name, "for_nothing", ".0f"),
                middle(peer.name, "stale", ".0f"),
                middle(peer.name, "repeated", ".0f"),
                middle(peer.name, "threads", ".0f"),
                middle(peer.name, "pss_mb", ".0f"),
                middle(peer.name, "first_tick_s", ".2f"),
                peer.codec,
            ]
        )
    header = [
        scenario.name,
        "tick, ms",
        "p99, ms",
        "CPU a tick, ms",
        "switches a tick",
        "wasted datagrams a tick",
        "stale inputs",
        "repeated stages",
        "threads",
        "PSS, MB",
        "first tick, s",
        "codec",
    ]
    return markdown(header, rows)


def _value(result: dict[str, Any], key: str) -> float | None:
    value = result.get(key)
    return None if value is None else float(value)


def _cpu_us(result: dict[str, Any]) -> float | None:
    """Returns CPU time; unknown if threads have ended, which took their counters along."""
    used_us = _value(result, "cpu_us")
    return None if used_us is None or used_us < 0 else used_us


def jitter_table(runs: Runs, scenarios: Sequence[OwnScenario]) -> str:
    """Returns the deviation of the period between iterations from the desired one."""
    rows = []
    for scenario in scenarios:
        spreads = [
            runs.spread("fwk", scenario.name, lambda result, share=share: error_us(result, share))  # type: ignore[misc]
            for share in (0.5, 0.99, 1.0)
        ]
        missed = runs.spread("fwk", scenario.name, lambda result: _value(result, "missed"))
        periods = runs.spread("fwk", scenario.name, lambda result: float(len(result["error_us"])))
        counts = [f"{each.middle:.0f}" if each else "-" for each in (missed, periods)]
        rows.append([scenario.name, *(milliseconds(spread) for spread in spreads), *counts])
    return markdown(["error of the period, ms", "median", "p99", "largest", "ticks missed", "periods"], rows)


def start_table(runs: Runs, scenarios: Sequence[OwnScenario]) -> str:
    """Returns the times of start and restart, and the memory."""
    rows = []
    for scenario in scenarios:
        row = [scenario.name]
        for key, form in (("processes", ".0f"), ("first_tick_s", ".2f"), ("pss_mb", ".0f"), ("restart_s", ".2f")):
            spread = runs.spread("fwk", scenario.name, lambda result, key=key: _value(result, key))  # type: ignore[misc]
            cell = "-" if spread is None else f"{spread.middle:{form}} ({spread.low:{form}}-{spread.high:{form}})"
            row.append(cell)
        rows.append(row)
    return markdown(["launch file", "all processes", "first tick, s", "PSS, MB", "component restarted, s"], rows)
