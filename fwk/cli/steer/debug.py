"""`fwk debug NAME`: one component of a running system in this terminal, under a debugger or none."""

import json
import os
import signal
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any

import typer

from fwk.cli.run_options import RunChoice, ask, asking
from fwk.control import runs
from fwk.control.client import ControlError, RefusedError
from fwk.host.attach import NoPlaceError, Place
from fwk.host.debugger import LEFT, DebuggerMissingError, DebugRequest, check
from fwk.host.terminal_guard import run_guarded
from fwk.model.errors import PlanError, Problems, hint
from fwk.model.plan import ComponentPlan, Plan
from fwk.model.plan_document import plan_from
from fwk.plan.files.folders import join
from fwk.program import BAD_INPUT, FAILED

WAIT_S = 60.0  # the component may be in a long iteration


def debug(
    name: Annotated[str, typer.Argument(metavar="NAME", help="a component of the run")],
    debugpy: Annotated[
        int | None,
        typer.Option(min=1, max=65535, metavar="PORT", help="wait for debugpy at this port, not for pdb"),
    ] = None,
    no_debugger: Annotated[
        bool, typer.Option("--no-debugger", help="only run it here, without a debugger; Ctrl-C gives it back")
    ] = False,
    chosen: RunChoice = None,
) -> None:
    """Runs one component of a running system in this terminal under pdb; leaving the debugger gives it back.

    It is a restart: the run's own process ends between two ticks, and a new one here, with the files as they are now,
    takes its place. At breakpoints the run waits in lockstep; in real time the loop goes on without the component.
    Exit code 0: given back; 1: the component failed or was ended; 2: the request was refused.
    """
    if debugpy and no_debugger:
        raise typer.BadParameter("--debugpy and --no-debugger exclude each other; keep one")
    with asking():
        port = runs.find(chosen)
        run = ask(port, "run")
        place = _place(run, port, name, no_debugger, debugpy or 0)
    code = run_guarded(place.take, run["pid"])
    typer.echo(f"{name}: {_end(code)}")
    raise typer.Exit(code if code in (FAILED, BAD_INPUT) else FAILED if code < 0 and code != -signal.SIGINT else 0)


def _place(run: Mapping[str, Any], port: int, name: str, no_debugger: bool, debugpy_port: int) -> Place:
    plan = _plan(Path(run["run_dir"]) / "plan.json")
    component = _component(plan, name)
    request = None if no_debugger else DebugRequest(component.host, component, debugpy_port)
    problems = Problems()
    join(plan.folders, problems)
    try:
        problems.stop_if_any()
        if request:
            check(request)
    except (PlanError, DebuggerMissingError) as error:
        raise RefusedError(str(error)) from error
    return Place(plan, component, os.readlink(f"/proc/{run['pid']}/cwd"), request, lambda: _take(port, name, request))


def _plan(file: Path) -> Plan:
    try:
        return plan_from(json.loads(file.read_text()))
    except (OSError, ValueError) as error:
        raise ControlError(f"{file}: the plan of the run cannot be read: {error}") from error


def _component(plan: Plan, name: str) -> ComponentPlan:
    found = {component.name: component for component in plan.components}
    if name not in found:
        raise RefusedError(f"no component '{name}'; {hint(name, found)}")
    return found[name]


def _take(port: int, name: str, request: DebugRequest | None) -> dict[str, Any]:
    try:
        return ask(port, "take_place", WAIT_S, name=name, held=request is not None)
    except ControlError as error:
        raise NoPlaceError(str(error)) from error


def _end(code: int) -> str:
    if code == BAD_INPUT:
        return "the run keeps it"
    if code == LEFT:
        return "given back"
    if code < 0:
        return f"ended by signal {-code}; given back, if the run goes on"
    return "failed; given back" if code == FAILED else "ended; given back, if the run goes on"
