"""Prints the runs that are going on."""

import json
from typing import Any

from fwk.cli.output import say, say_table
from fwk.clock import US_PER_S
from fwk.control import runs
from fwk.display.table import Column, Table


def show_runs(as_json: bool) -> int:
    """Prints a row for each run of this user."""
    found = runs.states()
    if as_json:
        say(json.dumps(found, indent=2))
    elif not found:
        say("nothing runs on this machine; start something with: fwk-launch FILE")
    else:
        say_table(_table(found))
    return 0


def _table(found: list[dict[str, Any]]) -> Table:
    table = Table(
        "run",
        Column("port", right=True),
        Column("pid", right=True),
        "state",
        Column("tick", right=True, rank=2),
        Column("time s", right=True, rank=1),
        Column("speed", right=True, rank=3),
        Column("components", right=True, rank=4),
        Column("file", rank=5),
        Column("run directory", rank=6),
    )
    for run in found:
        if not run["answers"]:
            table.add("", run["bus_port"], "", "does not answer", "", "", "", "", "", "", style="yellow")
            continue
        table.add(
            run.get("name") or run["plan"],
            run["bus_port"],
            run["pid"],
            _state(run),
            run["tick"],
            f"{run['time_us'] / US_PER_S:.1f}",
            f"{run['speed']:.2f}",
            run["components"],
            run["file"],
            run["run_dir"],
        )
    return table


def _state(run: dict[str, Any]) -> str:
    if run["paused"]:
        return "paused"
    if run["waits_for"]:
        return f"waits for {run['waits_for'][0]}"
    return f"running, {run['failed']} failed" if run["failed"] else "running"
