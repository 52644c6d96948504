"""`fwk start`, `stop`, `restart`, `reload`, `load`, `unload` and `kill`: the life of components in a run."""

import json
import os
import select
import signal
from typing import Annotated, Any

import typer

from fwk.cli.run_options import Json, Names, RunChoice, Timeout, ask, asking
from fwk.control import runs
from fwk.control.client import NoAnswerError, RefusedError
from fwk.control.requests import Action
from fwk.program import FAILED

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
    """Ends components immediately, also within an iteration, and does not start them again.

    No component sees any output of that iteration; `finalize` is not called. `fwk start` brings
    the components back.""",
)


def stop(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="NAME...", help="components, or patterns such as 'cyan1/*'")
    ] = None,
    whole: Annotated[bool, typer.Option("--all", help="end the whole run, as Ctrl-C in its terminal does")] = False,
    force: Annotated[bool, typer.Option("--force", help="also stop the components that need them")] = False,
    chosen: RunChoice = None,
    timeout_s: Timeout = WAIT_S,
    as_json: Json = False,
) -> None:
    """Stops components between two ticks: they finalize and leave the loop. With --all, ends the run.

    The last messages of stopped components stay visible to readers. Stopped components do not start again by
    themselves. Components that need them go on without --force.
    Exit code 0: done; 1: a component failed, or the time-out passed; 2: refused.
    """
    if bool(names) == whole:
        raise typer.BadParameter("name components, or end the whole run with --all")
    if whole:
        _end_run(chosen, timeout_s, as_json)
    else:
        _steer("stop", names or [], chosen, timeout_s, as_json, force)


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


def _end_run(chosen: str | None, timeout_s: float, as_json: bool) -> None:
    """Interrupts the process of the run, which the kernel names, and waits until it has ended."""
    with asking():
        with runs.supervisor(chosen) as run:
            about = run.ask("run")
            if run.pid != about["pid"]:
                raise RefusedError(f"process {about['pid']} of the run is not visible from here; end it there")
            process = os.pidfd_open(run.pid)
            signal.pidfd_send_signal(process, signal.SIGINT)
        ended = bool(select.select([process], [], [], timeout_s)[0])
        os.close(process)
        if not ended:
            raise NoAnswerError(f"{about['name']}: not ended within {timeout_s:g} s; pid {about['pid']}")
    if as_json:
        typer.echo(json.dumps({key: about[key] for key in ("name", "pid", "run_dir")}))
    else:
        typer.echo(f"{about['name']}: ended; run directory: {about['run_dir']}")


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
