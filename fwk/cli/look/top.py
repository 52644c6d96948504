"""`fwk top`: who takes how much, live."""

import json
import sys
from typing import Annotated, Any

import psutil
import typer
from rich.console import Console, Group
from rich.live import Live
from rich.table import Table
from rich.text import Text

from fwk.cli.look.status import WIDTH_IN_A_PIPE, headline
from fwk.cli.look.times import TITLES, Since, Stopwatch, stage_table, words
from fwk.cli.run_options import Json, RunChoice, asking
from fwk.clock import sleep_s
from fwk.control import client
from fwk.control.client import Client

_MEGABYTE = 1 << 20


def top(
    once: Annotated[bool, typer.Option("--once", help="one picture, then end")] = False,
    interval_s: Annotated[
        float, typer.Option("--interval", min=0.1, max=86_400, metavar="SECONDS", help="time from picture to picture")
    ] = 1.0,
    since: Annotated[
        Since,
        typer.Option(
            metavar="start|now|picture", help="since when times count: the run's start, now, the last picture"
        ),
    ] = "start",
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows CPU, memory and times of each process of a run, those that take most first; Ctrl-C ends it.

    CPU is in percent of one core. Times are wall time, exact to 6 %: of iterations, of stages, and from a tick's
    beginning to its end (loop) and to the next one's beginning (cycle). With `--json` there is a line for each picture,
    with the histograms in it: pairs of the longest time that a bucket counts and how many it has.
    """
    with asking(), client.supervisor(chosen) as run:
        meter = _Meter(since)
        meter.measure(run)
        sleep_s(interval_s)
        if once or as_json or not sys.stdout.isatty():
            _plain(run, meter, once, interval_s, as_json)
        else:
            _live(run, meter, interval_s)


class _Meter:
    """Measures processes; CPU is that since the last time."""

    def __init__(self, since: Since) -> None:
        self._known: dict[int, psutil.Process] = {}
        self._stopwatch = Stopwatch(since)

    def measure(self, run: Client) -> dict[str, Any]:
        """The status with `processes`: the run's own first, then each of its hosts, those that take most first.

        `times` are those of the loop, of stages and components.
        """
        answer, times = run.ask("status"), self._stopwatch.measure(run.ask("times"))
        hosts: dict[int, list[dict[str, Any]]] = {}
        for component in answer["components"]:
            if component["pid"]:
                hosts.setdefault(component["pid"], []).append(component)
        rows = [self._row(pid, held[0]["process"], held) for pid, held in hosts.items()]
        rows.sort(key=lambda row: (-row["cpu_percent"], row["name"]))
        own = self._row(answer["pid"], "supervisor", [])
        self._known = {pid: process for pid, process in self._known.items() if pid in hosts or pid == answer["pid"]}
        return {**answer, "processes": [own, *rows], "times": times}

    def _row(self, pid: int, name: str, held: list[dict[str, Any]]) -> dict[str, Any]:
        cpu, memory = 0.0, 0
        try:
            process = self._known.setdefault(pid, psutil.Process(pid))
            cpu, memory = process.cpu_percent(), process.memory_info().rss
        except psutil.Error:  # it has just ended
            self._known.pop(pid, None)
        return {
            "name": name,
            "pid": pid,
            "cpu_percent": cpu,
            "memory_bytes": memory,
            "components": [component["name"] for component in held],
            "state": ", ".join(dict.fromkeys(component["state"] for component in held)) or "running",
            "mean_ms": sum(component["mean_ms"] for component in held),
            "worst_ms": max((component["worst_ms"] for component in held), default=0.0),
            "lost": sum(component["lost"] for component in held),
        }


def _plain(run: Client, meter: _Meter, once: bool, interval_s: float, as_json: bool) -> None:
    console = Console(width=None if sys.stdout.isatty() else WIDTH_IN_A_PIPE)
    while True:
        measured = meter.measure(run)
        if as_json:
            typer.echo(json.dumps(measured))
        else:
            console.print(_picture(measured, len(measured["processes"])))
        if once:
            return
        sleep_s(interval_s)


def _live(run: Client, meter: _Meter, interval_s: float) -> None:
    console = Console()
    with Live(console=console, auto_refresh=False, screen=True) as live:
        while True:
            measured = meter.measure(run)
            live.update(_picture(measured, console.height - 9 - len(measured["times"]["stages"])), refresh=True)
            sleep_s(interval_s)


def _picture(measured: dict[str, Any], rows: int) -> Group:
    table = Table("process", "state", box=None, pad_edge=False)
    for title in ("pid", "CPU %", "MB", *TITLES, "lost"):
        table.add_column(title, justify="right")
    times = measured["times"]["components"]
    for row in measured["processes"][: max(1, rows)]:
        numbers = [f"{row['cpu_percent']:.0f}", f"{row['memory_bytes'] / _MEGABYTE:.0f}"]
        alone = row["components"] == [row["name"]] and row["name"] in times
        shown = words(times[row["name"]]) if alone else ["" for _ in TITLES]
        table.add_row(row["name"], row["state"], str(row["pid"]), *numbers, *shown, str(row["lost"] or ""))
        for name in [] if alone else row["components"]:
            shown = words(times[name]) if name in times else ["" for _ in TITLES]
            table.add_row(f"  {name}", "", "", "", "", *shown, "")
    lines = [Text(line, no_wrap=True, overflow="ellipsis") for line in headline(measured)]
    return Group(*lines, table, _sum(measured), Text(), stage_table(measured["times"]))


def _sum(measured: dict[str, Any]) -> Text:
    cpu = sum(row["cpu_percent"] for row in measured["processes"])
    memory = sum(row["memory_bytes"] for row in measured["processes"]) / _MEGABYTE
    return Text(
        f"{len(measured['processes'])} processes   CPU {cpu:.0f} %   {memory:.0f} MB (shared memory counted in each)"
    )
