"""Settings in the files of a plan, as `fwk config` reads and keeps them.

This module imports what plans need, which takes longer than a look at a run; so commands import it when they need it.
"""

from pathlib import Path
from typing import Any

import typer

from fwk.control.host_file import REFUSED_LATER, KeepError, Kept, forget, keep
from fwk.control.requests import RequestError
from fwk.control.settings import RunSettings
from fwk.control.settings_diff import differences
from fwk.model.errors import PlanError
from fwk.plan.classes import UnusableError
from fwk.plan.files.json_schema import schema_of_component, schema_of_file, schema_of_files
from fwk.plan.files.launch_file import host_file, shown
from fwk.plan.files.overrides import PLACE
from fwk.plan.load import LaunchOptions, load_plan
from fwk.program import BAD_INPUT, FAILED


def rows_of(file: str, names: list[str]) -> list[dict[str, Any]]:
    """Returns the settings of a launch file as a run tells its own."""
    try:
        return RunSettings(load_plan(file)).rows(names)
    except (PlanError, RequestError) as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error


def schema_of(of: str, host: bool) -> dict[str, Any]:
    """Returns the JSON Schema of a launch file, of a component's settings, or of all launch files."""
    try:
        if of.endswith((".yaml", ".yml")):
            return schema_of_file(of, host)
        return schema_of_component(of) if of else schema_of_files(host)
    except (PlanError, UnusableError) as error:
        typer.echo(f"error: {error}", err=True)
        raise typer.Exit(BAD_INPUT) from error


def keep_beside(launch_file: str, changes: list[str]) -> str:
    """Keeps settings in the host-specific file of a launch file; returns that file's name as people see it.

    A run takes settings that its launch file cannot have, such as a field that only one component knows.
    """
    try:
        load_plan(launch_file, LaunchOptions(sets=changes))
    except PlanError as error:
        mistakes = "\n".join(str(each).removeprefix(f"{PLACE}: ") for each in error.problems)
        typer.echo(f"error: {mistakes}\n{REFUSED_LATER}", err=True)
        raise typer.Exit(BAD_INPUT) from error
    file = host_file(Path(launch_file))
    try:
        keep(file, [Kept.of(each) for each in changes])
    except KeepError as error:
        typer.echo(f"error: {error}; nothing was set", err=True)
        raise typer.Exit(FAILED) from error
    return shown(file)


def forget_beside(launch_file: str, paths: list[str]) -> None:
    """Removes settings from the host-specific file of a launch file."""
    try:
        forget(host_file(Path(launch_file)), paths)
    except KeepError as error:
        typer.echo(f"error: {error}; nothing was changed", err=True)
        raise typer.Exit(FAILED) from error


def changed_in(
    launch_file: str, rows: list[dict[str, Any]], components: list[dict[str, Any]]
) -> tuple[list[str], list[str]]:
    """Returns the settings of a run that its files now state differently: those to set, and those for the next run.

    So are `every` and `offset` of `components` of the run.
    """
    try:
        return differences(rows, load_plan(launch_file), components)
    except PlanError as error:
        typer.echo(error, err=True)
        raise typer.Exit(BAD_INPUT) from error
