"""Candidates for the next word of a command line: commands, options, and names of running and recorded things."""

import os
import sys
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

from fwk.cli.index import Command, Parameter, read, subcommands
from fwk.control import runs
from fwk.control.client import ControlError

_TIMEOUT_S = 3.0  # a busy machine answers slowly
_LAUNCH_FILES = (".yaml", ".yml")


def complete(words: list[str]) -> list[str]:
    """Returns the candidates for the last word of a command line, which may be empty.

    A run that does not answer, or does not exist, has no candidates.
    """
    *typed, begun = words or [""]
    try:
        found = _candidates(typed, begun)
    except (ControlError, OSError, ValueError, KeyError):
        return []
    return sorted({each for each in found if each.startswith(begun)})


def _candidates(typed: list[str], begun: str) -> Iterable[str]:
    commands = read()
    path: tuple[str, ...] = ()
    while typed and (*path, typed[0]) in {each.words[: len(path) + 1] for each in commands}:
        path = (*path, typed.pop(0))
    command = next((each for each in commands if each.words == path), None)
    below = subcommands(commands, path)
    if command is None or below:
        return [] if typed else [*below, "--help"]
    option = command.option(typed[-1]) if typed else None
    if option and not option.flag:
        return _values(command, option, typed)
    if begun.startswith("-"):
        return [name for each in command.parameters for name in each.options] + ["--help"]
    places = command.arguments
    given = _given(command, typed)
    place = places[min(given, len(places) - 1)] if places and (given < len(places) or places[-1].many) else None
    return _values(command, place, typed) if place else []


def _given(command: Command, typed: list[str]) -> int:
    """Returns how many arguments have been typed, not counting options and their values."""
    count, skip = 0, False
    for word in typed:
        option = command.option(word)
        if not skip and option is None and not word.startswith("-"):
            count += 1
        skip = not skip and option is not None and not option.flag
    return count


def _values(command: Command, parameter: Parameter, typed: list[str]) -> Iterable[str]:
    if parameter.choices:
        return parameter.choices
    metavar = parameter.metavar.strip("[].")
    chosen = next((typed[at + 1] for at, word in enumerate(typed[:-1]) if word in ("--run", "--bus-port")), None)
    if command.words == ("fwk", "call"):
        metavar = "COMMANDS"
    file = next((word for word in typed if word.endswith(_LAUNCH_FILES)), None)
    if file and chosen is None and metavar in _IN_FILE:
        return _IN_FILE[metavar](_rows(file))
    source = _SOURCES.get(metavar)
    return source(chosen) if source else []


def _rows(file: str) -> list[dict[str, Any]]:
    """Returns the settings of a launch file that was typed before; none of one that has mistakes."""
    from fwk.control.settings import RunSettings
    from fwk.model.errors import PlanError
    from fwk.plan.load import load_plan

    try:
        with redirect_stdout(sys.stderr):  # modules of components may print
            return RunSettings(load_plan(file)).rows([])
    except PlanError:
        return []


def _components_of(rows: list[dict[str, Any]]) -> Iterable[str]:
    return (row["component"] for row in rows)


def _assignments_of(rows: list[dict[str, Any]]) -> Iterable[str]:
    return (f"{row['component']}.{row['setting']}=" for row in rows)


def _components(chosen: str | None) -> Iterable[str]:
    return (each["name"] for each in _ask(chosen, "status")["components"])


def _settings(chosen: str | None) -> Iterable[str]:
    return (f"{row['component']}.{row['setting']}" for row in _ask(chosen, "settings")["settings"])


def _assignments(chosen: str | None) -> Iterable[str]:
    return (f"{path}=" for path in _settings(chosen))


def _channels(chosen: str | None) -> Iterable[str]:
    with runs.gateway(chosen) as gateway:
        return [row["channel"] for row in gateway.ask("channels", _TIMEOUT_S)["channels"]]


def _commands(chosen: str | None) -> Iterable[str]:
    return (each.partition("@")[0] for each in _channels(chosen) if "@" in each)


def _runs(_: str | None) -> Iterable[str]:
    return (str(run.get("name") or port) for port, run in runs.look().items())


def _run_directories(_: str | None) -> Iterable[str]:
    from fwk.cli.run.run_directory import RUNS

    folder = Path.home() / RUNS
    return os.listdir(folder) if folder.is_dir() else ()


def _recordings(_: str | None) -> Iterable[str]:
    """Returns the run directories, and the names of their runs, of which each stands for the newest."""
    from fwk.cli.run.run_directory import own_name

    folders = [*_run_directories(None)]
    return [*folders, *filter(None, map(own_name, folders))]


def _launch_files(_: str | None) -> Iterable[str]:
    return (each for each in os.listdir("launch") if each.endswith(_LAUNCH_FILES)) if os.path.isdir("launch") else ()


def _ask(chosen: str | None, verb: str) -> dict[str, Any]:
    with runs.supervisor(chosen) as run:
        return run.ask(verb, _TIMEOUT_S)


_SOURCES: dict[str, Callable[[str | None], Iterable[str]]] = {
    "NAME": _components,
    "NAME|N": _runs,
    "CHANNEL": _channels,
    "PATTERN": _channels,
    "COMMANDS": _commands,
    "NAME.SETTING": _settings,
    "NAME.SETTING=VALUE": _assignments,
    "RUN": _run_directories,
    "RUN_OR_LOG": _recordings,
    "LOG": _recordings,
    "A": _recordings,
    "B": _recordings,
    "FILE": _launch_files,
}
"""Metavar of a parameter to the source of its values. The shells add file names where a source gives none."""
_IN_FILE: dict[str, Callable[[list[dict[str, Any]]], Iterable[str]]] = {
    "NAME": _components_of,
    "PATH=VALUE": _assignments_of,
    "NAME.SETTING": lambda rows: (each.rstrip("=") for each in _assignments_of(rows)),
}
"""Metavar of a parameter to what the settings of a typed launch file offer for it."""
