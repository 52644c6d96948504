"""What start, stop, restart, reload, load, unload and kill have in common."""

import json
from typing import Any

import typer

from fwk.cli.asking import FAILED, ask, asking
from fwk.control.requests import Action

WAIT_S = 30.0


def steer(
    action: Action, names: list[str], bus_port: int | None, timeout_s: float, as_json: bool, force: bool = False
) -> None:
    """Asks for it, waits until it has happened, says what came of it; exit code 1 if a component failed."""
    with asking():
        answer = ask(bus_port, "steer", timeout_s, action=action, names=names, force=force)
    if as_json:
        typer.echo(json.dumps(answer))
    else:
        for process in answer["processes"]:
            typer.echo(_sentence(process, answer["tick"]))
        for each in answer["left_without"]:
            typer.echo(f"{each['channel']} keeps its last value for {', '.join(each['readers'])}")
    if any(process["state"] == "failed" for process in answer["processes"]):
        raise typer.Exit(FAILED)


def _sentence(process: dict[str, Any], tick: int) -> str:
    reason = f": {process['reason']}" if process["reason"] else ""
    return f"{process['name']} {process['state']}, tick {tick}{reason}"
