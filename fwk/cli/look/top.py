"""`fwk top`: CPU, memory and times of each process, live."""

import json
import sys
from typing import Annotated, Any

import psutil
import typer
from rich.console import Console
from rich.live import Live
from rich.text import Text

from fwk.cli.look.show_status import headline
from fwk.cli.look.times import TITLES, Since, Stopwatch, stage_table, words
from fwk.cli.output import say
from fwk.cli.run_options import Json, RunChoice, asking
from fwk.clock import sleep_s
from fwk.control import runs
from fwk.control.client import Client
from fwk.display.table import Column, Table, terminal_width

_MEGABYTE = 1 << 20


def top(
    once: Annotated[bool, typer.Option("--once", help="print one table and end")] = False,
    interval_s: Annotated[
        float, typer.Option("--interval", min=0.1, max=86_400, metavar="SECONDS", help="time from table to table")
    ] = 1.0,
    since: Annotated[
        Since,
        typer.Option(
            metavar="start|now|picture", help="start of the measurement: the run's start, now, or the last table"
        ),
    ] = "start",
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Shows CPU, memory and times of each process of a run, the busiest first; Ctrl-C ends it.

    CPU is in percent of one core. Times are wall time, exact to 6 %: of iterations, of stages, and from a tick's
    beginning to its end (loop) and to the next one's beginning (cycle). `--json` prints a line
    for each picture, with the histograms: pairs of the longest time that a bucket counts and its count.
    """
    with asking(), runs.supervisor(chosen) as run:
        meter = _Meter(since)
        meter.measure(run)
        sleep_s(interval_s)
        if once or as_json or not sys.stdout.isatty():
            _plain(run, meter, once, interval_s, as_json)
        else:
            _live(run, meter, interval_s)


class _Meter:
    """Measures processes; CPU is that since the last measurement."""

    def __init__(self, since: Since) -> None:
        self._known: dict[int, psutil.Process] = {}
        self._stopwatch = Stopwatch(since)

    def measure(self, run: Client) -> dict[str, Any]:
        """Returns the status with `processes`: the supervisor first, then the hosts, the busiest first.

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
    while True:
        measured = meter.measure(run)
        if as_json:
            typer.echo(json.dumps(measured))
        else:
            say(*_picture(measured, len(measured["processes"]), terminal_width()))
        if once:
            return
        sleep_s(interval_s)


def _live(run: Client, meter: _Meter, interval_s: float) -> None:
    console = Console()
    with Live(console=console, auto_refresh=False, screen=True) as live:
        while True:
            measured = meter.measure(run)
            rows = console.height - 10 - len(measured["times"]["stages"])
            lines = _picture(measured, rows, console.width)
            live.update(Text("\n".join(lines), no_wrap=True, overflow="crop"), refresh=True)
            sleep_s(interval_s)


def _picture(measured: dict[str, Any], rows: int, width: int | None) -> list[str]:
    ranks = {"pid": 5, "CPU %": 0, "MB": 1, TITLES[0]: 2, TITLES[1]: 4, TITLES[2]: 3, TITLES[3]: 2, "lost": 1}
    table = Table("process", Column("state", rank=2), *(Column(title, True, rank) for title, rank in ranks.items()))
    times = measured["times"]["components"]
    for row in measured["processes"][: max(1, rows)]:
        numbers = [f"{row['cpu_percent']:.0f}", f"{row['memory_bytes'] / _MEGABYTE:.0f}"]
        alone = row["components"] == [row["name"]] and row["name"] in times
        shown = words(times[row["name"]]) if alone else ["" for _ in TITLES]
        table.add(row["name"], row["state"], str(row["pid"]), *numbers, *shown, str(row["lost"] or ""))
        for name in [] if alone else row["components"]:
            shown = words(times[name]) if name in times else ["" for _ in TITLES]
            table.add(f"  {name}", "", "", "", "", *shown, "")
    stages = stage_table(measured["times"])
    return [*headline(measured), *table.lines(width), _sum(measured), "", *stages.lines(width)]


def _sum(measured: dict[str, Any]) -> str:
    cpu = sum(row["cpu_percent"] for row in measured["processes"])
    memory = sum(row["memory_bytes"] for row in measured["processes"]) / _MEGABYTE
    return f"{len(measured['processes'])} processes   CPU {cpu:.0f} %   {memory:.0f} MB (shared memory counted in each)"
