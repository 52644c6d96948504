"""`fwk config`: settings of a run with their origins, and live changes."""

import json
from typing import Annotated, Any

import typer

from fwk.cli.conditions import pattern
from fwk.cli.output import say_table
from fwk.cli.run_options import Json, RunChoice, asking
from fwk.control import runs
from fwk.control.client import Client, ControlError
from fwk.display.table import Column, Table
from fwk.model.selection import matches
from fwk.program import FAILED

config = typer.Typer(add_completion=False, no_args_is_help=True)
SomeSettings = Annotated[
    list[str] | None,
    typer.Argument(metavar="NAME...", help="components, patterns, or NAME.SETTING; all by default"),
]

LaunchFile = Annotated[
    str | None, typer.Option("--file", metavar="FILE", help="settings of this launch file, not of a run")
]


@config.callback()
def settings() -> None:
    """Shows the settings of a run with their origins, and changes them between two ticks."""


@config.command("list")
def list_settings(
    names: SomeSettings = None, file: LaunchFile = None, chosen: RunChoice = None, as_json: Json = False
) -> None:
    """Lists every effective setting with its origin and meaning."""
    _show(_rows(names or [], file, chosen), as_json)


@config.command()
def search(
    text: Annotated[
        str, typer.Argument(metavar="REGEXP", help="matched against name, value, origin and meaning, ignoring case")
    ],
    file: LaunchFile = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Lists the settings that match a text; exit code 1 if none does."""
    wanted = pattern(text, "REGEXP")
    rows = [row for row in _rows([], file, chosen) if any(map(wanted.search, _texts(row)))]
    if not rows and not as_json:
        typer.echo(f"error: no setting matches '{text}'", err=True)
        raise typer.Exit(FAILED)
    _show(rows, as_json)


@config.command()
def schema(
    of: Annotated[
        str, typer.Argument(metavar="FILE|MODULE", help="a launch file, or a component's module: only its settings")
    ] = "",
    host: Annotated[bool, typer.Option("--host", help="the schema of host-specific files, NAME.host.yaml")] = False,
) -> None:
    """Prints the JSON Schema of launch files, with all settings and ports of the components found from here.

    With FILE, the schema also knows the names of its components. Editors use it to complete and check launch files; see
    docs/launch-file.md.
    """
    from fwk.cli.steer.setting_files import schema_of

    typer.echo(json.dumps(schema_of(of, host), indent=1))


@config.command()
def get(
    path: Annotated[str, typer.Argument(metavar="NAME.SETTING", help="such as cyan1/omni_ball.least_fit")],
    file: LaunchFile = None,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Prints the value of a setting; for a pattern or a mapping, a line with name and value for each match."""
    rows = _rows([path], file, chosen)
    if as_json:
        typer.echo(json.dumps(rows, indent=2))
    elif [_path(row) for row in rows] == [path]:
        typer.echo(_value(rows[0]["value"]))
    else:
        for row in rows:
            typer.echo(f"{_path(row)} = {_value(row['value'])}")


@config.command("set")
def set_settings(
    changes: Annotated[
        list[str], typer.Argument(metavar="NAME.SETTING=VALUE...", help="such as cyan1/omni_ball.least_fit=0.5")
    ],
    save: Annotated[
        bool, typer.Option("--save", help="also keep them in the host-specific file for later runs")
    ] = False,
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Changes settings between two ticks, all of them or none, and prints the tick from which on they apply.

    `--save` first keeps them in NAME.host.yaml beside the launch file NAME.yaml. If that fails, nothing is changed.
    """
    origin, kept_in = "fwk config set", ""
    with asking(), runs.supervisor(chosen) as run:
        if save:
            from fwk.cli.steer.setting_files import keep_beside

            run.ask("set", changes=changes, check=True)
            kept_in = keep_beside(run.ask("run")["file"], changes)
            origin = f"{origin} --save, {kept_in}"
        try:
            answer = run.ask("set", changes=changes, origin=origin)
        except ControlError as error:
            raise type(error)(f"{error}; for later runs it is kept in {kept_in}" if kept_in else str(error)) from error
    if as_json:
        typer.echo(json.dumps(answer))
        return
    _say(answer, f", kept in {kept_in}" if kept_in else "")


@config.command()
def unset(
    paths: Annotated[list[str], typer.Argument(metavar="NAME.SETTING...", help="such as cyan1/omni_ball.least_fit")],
    chosen: RunChoice = None,
    as_json: Json = False,
) -> None:
    """Removes settings from the host-specific file, all or none; the run gets the values of the other files.

    NAME is the name or pattern that was typed with `fwk config set --save`.
    """
    with asking(), runs.supervisor(chosen) as run:
        from fwk.cli.steer.setting_files import forget_beside

        run.ask("settings", names=paths)
        forget_beside(run.ask("run")["file"], paths)
        _take_over(run, paths, "fwk config unset", as_json)


@config.command()
def reload(names: SomeSettings = None, chosen: RunChoice = None, as_json: Json = False) -> None:
    """Reads the launch files again and applies changed settings.

    Settings given with --set at the start stay; live changes that were not kept are undone. Settings that cannot be
    changed during a run are named, as are 'every' and 'offset', and mappings that got a key: it stays until the run
    ends.
    """
    with asking(), runs.supervisor(chosen) as run:
        _take_over(run, names or [], "fwk config reload", as_json)


def _take_over(run: Client, names: list[str], origin: str, as_json: bool) -> None:
    from fwk.cli.steer.setting_files import changed_in

    rows, told = run.ask("settings", names=names)["settings"], run.ask("status")
    whole = [each for each in told["components"] if any(matches(each["name"], name) for name in names or ["*"])]
    changes, later = changed_in(told["file"], rows, whole)
    answer = run.ask("set", changes=changes, origin=origin) if changes else {"settings": []}
    if as_json:
        typer.echo(json.dumps({**answer, "later": later}))
        return
    for each in later:
        typer.echo(f"{each}: from the next run on")
    if not changes and not later:
        typer.echo("no setting in the files has changed")
    elif changes:
        _say(answer, "")


@config.command()
def watch(names: SomeSettings = None, chosen: RunChoice = None, as_json: Json = False) -> None:
    """Shows each change of a setting as it happens, until the run ends."""
    with asking(), runs.supervisor(chosen) as run:
        known: dict[str, Any] = {}
        for answer in run.follow("watch_settings", names=names or []):
            now = {_path(row): row for row in answer["settings"]}
            changed = {path: row for path, row in now.items() if path in known and row != known[path]}
            known |= now
            for path, row in changed.items():
                if as_json:
                    typer.echo(json.dumps({**row, "tick": answer["tick"]}))
                else:
                    typer.echo(f"tick {answer['tick']}: {path} = {_value(row['value'])} ({row['origin']})")


def _rows(names: list[str], file: str | None, chosen: str | None) -> list[dict[str, Any]]:
    with asking():
        if file is None:
            with runs.supervisor(chosen) as run:
                found: list[dict[str, Any]] = run.ask("settings", names=names)["settings"]
            return found
        from fwk.cli.steer.setting_files import rows_of

        return rows_of(file, names)


def _show(rows: list[dict[str, Any]], as_json: bool) -> None:
    if as_json:
        typer.echo(json.dumps(rows, indent=2))
        return
    table = Table(
        "setting",
        "value",
        Column("type", rank=3),
        Column("live", rank=4),
        Column("origin", rank=2),
        Column("meaning", rank=1, prose=True),
    )
    for row in rows:
        path, value, kind, *others = _texts(row)
        table.add(path, value, kind, "yes" if row["editable"] else "no", *others)
    say_table(table)


def _texts(row: dict[str, Any]) -> tuple[str, ...]:
    return _path(row), _value(row["value"]), row["type"], row["origin"], row["meaning"]


def _value(value: object) -> str:
    """Returns a value as people type it, in any script."""
    return json.dumps(value, ensure_ascii=False)


def _say(answer: dict[str, Any], kept: str) -> None:
    for component in answer["settings"]:
        for setting, value in component["values"].items():
            typer.echo(f"{component['component']}.{setting} = {_value(value)} since tick {answer['tick']}{kept}")


def _path(row: dict[str, Any]) -> str:
    return f"{row['component']}.{row['setting']}"
