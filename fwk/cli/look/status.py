"""`fwk status`: the run and its components."""

import json
import sys
from typing import Any

import typer
from rich.console import Console
from rich.table import Table

from fwk.cli.run_options import Json, RunChoice, SomeNames, ask, asking
from fwk.clock import US_PER_S, rate_word

WIDTH_IN_A_PIPE = 220
_STYLES = {"running": "green", "failed": "bold red", "late": "yellow", "held": "yellow", "stopped": "dim"}


def status(names: SomeNames = None, chosen: RunChoice = None, as_json: Json = False) -> None:
    """Shows the run, and of each component state, process, iterations, times, losses and reason.

    For one component alone it shows everything that is known of it, its settings too.
    """
    with asking():
        answer = ask(chosen, "status", names=names or [])
        alone = answer["components"][0] if names and len(answer["components"]) == 1 else None
        if alone:
            alone["parameters"] = ask(chosen, "parameters", name=alone["name"])["parameters"]
    if as_json:
        typer.echo(json.dumps(answer, indent=2))
        return
    console = Console(width=None if sys.stdout.isatty() else WIDTH_IN_A_PIPE)
    for line in headline(answer):
        console.print(line, highlight=False, markup=False, soft_wrap=True)
    console.print(_one(alone) if alone else component_table(answer["components"]))


def headline(answer: dict[str, Any]) -> list[str]:
    """The run as a whole."""
    lines = [
        f"{answer['plan']}: pid {answer['pid']}, --bus-port {answer['bus_port']}, {answer['run_dir']}",
        f"tick {answer['tick']}   {answer['time_us'] / US_PER_S:.2f} s   speed {answer['speed']:.2f}   "
        f"{answer['ticks_per_s']:.1f} ticks/s   late {answer['late']}   repeated {answer['repeated']}",
    ]
    if answer["main_loop"]:
        lines.append(f"{answer['main_loop']} has the main loop: {', '.join(answer['order'])}")
    if answer["paused"]:
        lines.append(f"paused after tick {answer['tick']}; 'fwk resume' goes on, 'fwk step' runs one tick")
    if answer["waits_for"]:
        lines.append(f"waits for {', '.join(answer['waits_for'])}")
    return lines


def component_table(components: list[dict[str, Any]]) -> Table:
    """A row a component."""
    table = Table("component", "state", "stage", box=None, pad_edge=False)
    for title in ("pid", "starts", "iterations", "mean ms", "worst ms", "fetched", "lost", "refused"):
        table.add_column(title, justify="right")
    table.add_column("reason")
    for each in components:
        state = f"[{_STYLES.get(each['state'], 'cyan')}]{each['state']}[/]"
        numbers = [str(each["pid"] or ""), str(each["starts"]), str(each["iterations"])]
        times = [f"{each['mean_ms']:.2f}", f"{each['worst_ms']:.1f}"]
        losses = [str(each[key] or "") for key in ("fetched", "lost", "strangers")]
        table.add_row(each["name"], state, _when(each), *numbers, *times, *losses, each["reason"])
    return table


def _when(component: dict[str, Any]) -> str:
    """In which stages a component runs, or how often."""
    return ", ".join(component["stages"]) if component["rate_hz"] is None else rate_word(component["rate_hz"])


def _one(component: dict[str, Any]) -> Table:
    table = Table("what", "value", box=None, pad_edge=False, show_header=False)
    for key, value in component.items():
        if key != "parameters":
            words = ", ".join(map(str, value)) if isinstance(value, list) else value
            table.add_row(key, f"{words:.3f}" if isinstance(words, float) else str(words))
    for each in component["parameters"]:
        note = f"({each['type']}, {each['origin']}{'' if each['editable'] else ', fixed'})"
        table.add_row(f"config.{each['setting']}", f"{json.dumps(each['value'])}  {note}")
    return table
