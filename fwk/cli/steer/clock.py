"""`fwk pause`, `resume`, `step` and `speed`: the simulated time of a run."""

import json
from typing import Annotated, Any

import typer

from fwk.cli.arguments import speed as parse_speed
from fwk.cli.run_options import Json, RunChoice, Timeout, ask, asking
from fwk.clock import US_PER_S, speed_word


def pause(chosen: RunChoice = None, timeout_s: Timeout = 30.0, as_json: Json = False) -> None:
    """Stops simulated time after the current tick; the results of the run do not change.

    While a run is paused, components can be stopped, started, restarted and configured; settings apply from the next
    tick on. A run with `clock: wall` refuses.
    """
    _ask_clock("pause", chosen, timeout_s, as_json)


def resume(chosen: RunChoice = None, timeout_s: Timeout = 30.0, as_json: Json = False) -> None:
    """Continues a paused run at its previous speed."""
    _ask_clock("resume", chosen, timeout_s, as_json)


def step(
    ticks: Annotated[int, typer.Argument(min=1, metavar="TICKS", help="number of ticks; 1 by default")] = 1,
    chosen: RunChoice = None,
    timeout_s: Timeout = 600.0,
    as_json: Json = False,
) -> None:
    """Runs the given number of ticks at the run's speed, then pauses, even if the run was not paused before."""
    _ask_clock("step", chosen, timeout_s, as_json, ticks=ticks)


def speed(
    pace: Annotated[
        float | None,
        typer.Argument(
            parser=parse_speed, metavar="F|max", help="logical seconds per wall second; max: as fast as possible"
        ),
    ] = None,
    chosen: RunChoice = None,
    timeout_s: Timeout = 30.0,
    as_json: Json = False,
) -> None:
    """Sets the speed of simulated time from the next tick on; without a number, prints tick, time and speed."""
    _ask_clock("speed", chosen, timeout_s, as_json, **({} if pace is None else {"speed": pace}))


def _ask_clock(verb: str, chosen: str | None, timeout_s: float, as_json: bool, **fields: Any) -> None:
    """Sends the request, waits for its effect and prints the clock."""
    with asking():
        answer = ask(chosen, verb, timeout_s, **fields)
    if as_json:
        typer.echo(json.dumps(answer))
        return
    how = "paused" if answer["paused"] else f"running at speed {speed_word(answer['pace'])}"
    typer.echo(f"{how}, tick {answer['tick']}, {answer['time_us'] / US_PER_S:.3f} s")
