"""`fwk start`, `stop`, `restart`, `reload`, `load`, `unload` and `kill`: the life of components in a run."""

import json
from typing import Annotated, Any

import typer

from fwk.cli.run_options import FAILED, Json, Names, RunChoice, Timeout, ask, asking
from fwk.control.requests import Action

WAIT_S = 30.0
_EXIT_CODES = "Exit code 0: done; 1: a component failed, or the time-out passed; 2: refused."


def _command(action: Action, explanation: str) -> Any:
    """Returns the typer function of one action; `explanation` is its help."""

    def command(names: Names, chosen: RunChoice = None, timeout_s: Timeout = WAIT_S, as_json: Json = False) -> None:
        _steer(action, names, chosen, timeout_s, as_json)

    command.__doc__ = f"{explanation}\n    {_EXIT_CODES}"
    return command


start = _command(
    "start",
    """Starts components that were stopped or have failed.

    Their channels continue with the next sequence number. A component is refused while its needs do not run.""",
)
stop = _command(
    "stop",
    """Stops components between two ticks: they finalize and leave the loop.

    Their last messages stay visible to readers. Stopped components do not start again by themselves.""",
)
restart = _command(
    "restart",
    """Stops components between two ticks and starts them again.

    Earlier failures are forgotten, so a component that has failed for good gets another try.""",
)
reload = _command(
    "reload",
    """Restarts components with their changed code; all others keep running.

    The processes of these components import the modules of the application anew.""",
)
load = _command(
    "load",
    """Starts components together with everything that they need.

    Needs are the components named in the launch file and the vision masters of the images.""",
)
kill = _command(
    "kill",
    """Ends components at once, even in the middle of an iteration, and does not start them again.

    No component sees any output of that iteration; `finalize` is not called. `fwk start` brings
    the components back.""",
)


def unload(
    names: Names,
    force: Annotated[bool, typer.Option("--force", help="also unload the components that need them")] = False,
    chosen: RunChoice = None,
    timeout_s: Timeout = WAIT_S,
    as_json: Json = False,
) -> None:
    """Stops components that no other component needs any more.

    The command is refused while another running component needs one of them; name all of them together, or take the
    dependents along with --force. A component that only reads their channels is no obstacle: it keeps the last value,
    and the answer names it.
    Exit code 0: done; 1: a component failed, or the time-out passed; 2: refused.
    """
    _steer("unload", names, chosen, timeout_s, as_json, force)


def _steer(
    action: Action, names: list[str], chosen: str | None, timeout_s: float, as_json: bool, force: bool = False
) -> None:
    """Sends the request, waits for its effect and prints it; exit code 1 if a component failed."""
    with asking():
        answer = ask(chosen, "steer", timeout_s, action=action, names=names, force=force)
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
