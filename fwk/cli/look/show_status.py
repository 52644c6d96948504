"""Prints the state of a run and of its components."""

import json
from typing import Any

from fwk.cli.output import say, say_table
from fwk.clock import US_PER_S, rate_word, turns_word
from fwk.control import runs
from fwk.display.table import Column, Table

_STYLES = {"running": "", "failed": "red", "late": "yellow", "held": "yellow", "stopped": "dim"}


def show_status(names: list[str], chosen: str | None, as_json: bool) -> int:
    """Prints the status; for one component alone, everything that is known of it."""
    with runs.supervisor(chosen) as run:
        answer = run.ask("status", names=names)
        alone = answer["components"][0] if names and len(answer["components"]) == 1 else None
        if alone:
            alone["parameters"] = run.ask("parameters", name=alone["name"])["parameters"]
    if as_json:
        say(json.dumps(answer, indent=2))
        return 0
    say(*headline(answer))
    say_table(_one(alone) if alone else component_table(answer["components"]))
    return 0


def headline(answer: dict[str, Any]) -> list[str]:
    """Returns the lines about the run as a whole."""
    lines = [
        f"{answer.get('name') or answer['plan']}: pid {answer['pid']}, --bus-port {answer['bus_port']}",
        f"tick {answer['tick']}   {answer['time_us'] / US_PER_S:.2f} s   speed {answer['speed']:.2f}   "
        f"{answer['ticks_per_s']:.1f} ticks/s   late {answer['late']}   repeated {answer['repeated']}",
        answer["run_dir"],
    ]
    if answer["main_loop"]:
        lines.append(f"{answer['main_loop']} has the main loop: {', '.join(answer['order'])}")
    if answer["paused"]:
        lines.append(f"paused after tick {answer['tick']}; 'fwk resume' goes on, 'fwk step' runs one tick")
    if answer["waits_for"]:
        lines.append(f"waits for {', '.join(answer['waits_for'])}")
    return lines


def component_table(components: list[dict[str, Any]]) -> Table:
    """Returns a table with a row for each component."""
    table = Table(
        "component",
        "state",
        Column("stage", rank=3),
        Column("pid", right=True, rank=5),
        Column("starts", right=True, rank=6),
        Column("iterations", right=True, rank=4),
        Column("mean ms", right=True, rank=1),
        Column("worst ms", right=True, rank=2),
        Column("fetched", right=True, rank=7),
        Column("lost", right=True, rank=1),
        Column("refused", right=True, rank=8),
        Column("reason", prose=True, rank=1),
    )
    for each in components:
        numbers = [str(each["pid"] or ""), str(each["starts"]), str(each["iterations"])]
        times = [f"{each['mean_ms']:.2f}", f"{each['worst_ms']:.1f}"]
        losses = [str(each[key] or "") for key in ("fetched", "lost", "strangers")]
        style = _STYLES.get(each["state"], "cyan")
        table.add(each["name"], each["state"], _when(each), *numbers, *times, *losses, each["reason"], style=style)
    return table


def _when(component: dict[str, Any]) -> str:
    """Returns the stages of a component, or its rate."""
    if component["rate_hz"] is not None:
        return rate_word(component["rate_hz"])
    return ", ".join(component["stages"]) + turns_word(component["every"], component["offset"])


def _one(component: dict[str, Any]) -> Table:
    table = Table("", Column("", prose=True))
    for key, value in component.items():
        if key != "parameters":
            words = ", ".join(map(str, value)) if isinstance(value, list) else value
            table.add(key, f"{words:.3f}" if isinstance(words, float) else str(words))
    for each in component["parameters"]:
        note = f"({each['type']}, {each['origin']}{'' if each['editable'] else ', fixed'})"
        table.add(f"config.{each['setting']}", f"{json.dumps(each['value'])}  {note}")
    return table
