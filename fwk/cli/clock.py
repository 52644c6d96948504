"""What pause, resume, step and speed have in common."""

import json
from typing import Any

import typer

from fwk.cli.asking import ask, asking
from fwk.clock import US_PER_S, speed_word


def ask_clock(verb: str, bus_port: int | None, timeout_s: float, as_json: bool, **fields: Any) -> None:
    """Asks for it, waits until it has happened, says where the clock is then."""
    with asking():
        answer = ask(bus_port, verb, timeout_s, **fields)
    if as_json:
        typer.echo(json.dumps(answer))
        return
    how = "paused" if answer["paused"] else f"goes on at speed {speed_word(answer['pace'])}"
    typer.echo(f"{how}, tick {answer['tick']}, {answer['time_us'] / US_PER_S:.3f} s")
