"""Candidates for the next word of a command line: commands, options, and names of running and recorded things."""

import os
import sys
from collections.abc import Callable, Iterable
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

from fwk.cli.complete import of_recordings, of_runs
from fwk.cli.complete.of_fields import fields_of, fields_to_plot
from fwk.cli.index import Command, Parameter, read, subcommands

_LAUNCH_FILES = (".yaml", ".yml")


def complete(words: list[str]) -> list[str]:
    """Returns the candidates for the last word of a command line, which may be empty.

    What cannot be read, such as a run that does not answer, has no candidates.
    """
    *typed, begun = words or [""]
    try:
        return sorted({each for each in _candidates(typed, begun) if each.startswith(begun)})
    except Exception:  # whatever is wrong: the command itself says so
        return []


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
        return _values(command, option, typed, begun)
    if begun.startswith("-"):
        return [name for each in command.parameters for name in each.options] + ["--help"]
    places = command.arguments
    given = sum(not each.options for each, _ in _placed(command, typed))
    place = places[min(given, len(places) - 1)] if places and (given < len(places) or places[-1].many) else None
    return _values(command, place, typed, begun) if place else []


def _placed(command: Command, typed: list[str]) -> list[tuple[Parameter, str]]:
    """Returns the arguments and the values of options that have been typed, each with its parameter."""
    found: list[tuple[Parameter, str]] = []
    places, option = command.arguments, None
    for word in typed:
        named = command.option(word)
        if option:
            found.append((option, word))
            option = None
        elif named is None and not word.startswith("-") and places:
            found.append((places[0], word))
            places = places if places[0].many else places[1:]
        elif named is not None and not named.flag:
            option = named
    return found


def _values(command: Command, parameter: Parameter, typed: list[str], begun: str) -> Iterable[str]:
    if parameter.choices:
        return parameter.choices
    metavar = parameter.metavar.strip("[].")
    placed = {each.metavar.strip("[]."): word for each, word in _placed(command, typed)}
    chosen = next((word for each, word in _placed(command, typed) if {"--run", "--bus-port"} & {*each.options}), None)
    own = _OF_COMMAND.get((*command.words[1:], metavar))
    if own:
        return own(chosen)
    file = next((word for word in typed if word.endswith(_LAUNCH_FILES)), None)
    if file and chosen is None and metavar in _IN_FILE:
        return _IN_FILE[metavar](_rows(file))
    recording = next((placed[each] for each in of_recordings.RECORDING if each in placed), None)
    if metavar == "CHANNEL.FIELD":
        types = of_recordings.types_in(of_recordings.plan_of(recording)) if recording else of_runs.types(chosen)
        return fields_to_plot(types, begun)
    if metavar in ("FIELD", "FIELD=VALUE") and "CHANNEL" in placed:
        fields = fields_of(of_runs.types(chosen)[placed["CHANNEL"]])
        return [f"{each}=" for each in fields] if "=" in metavar else fields
    if recording and metavar in of_recordings.SOURCES:
        return of_recordings.SOURCES[metavar](of_recordings.plan_of(recording))
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


def _kinds(_: str | None) -> Iterable[str]:
    from fwk.scaffold.templates import kinds

    return kinds()


def _kinds_of_types(_: str | None) -> Iterable[str]:
    from fwk.scaffold.interface import KINDS

    return KINDS


def _languages(_: str | None) -> Iterable[str]:
    from fwk.scaffold.bindings import LANGUAGES

    return "python", *LANGUAGES


def _templates(_: str | None) -> Iterable[str]:
    from fwk.monitor.script import templates

    return templates()


def _modules(_: str | None) -> Iterable[str]:
    """Returns the modules of the project in this folder."""
    from fwk.scaffold.project import project_at

    project = project_at(Path.cwd())
    return (each.stem for each in (project.root / project.package).glob("*.py") if each.stem != "__init__")


def _nothing(_: str | None) -> Iterable[str]:
    return ()


_SOURCES: dict[str, Callable[[str | None], Iterable[str]]] = {
    "NAME": of_runs.components,
    "NAME|N": of_runs.names,
    "CHANNEL": of_runs.channels,
    "PATTERN": of_runs.channels,
    "NAME.SETTING": of_runs.settings,
    "NAME.SETTING=VALUE": of_runs.assignments,
    "COMPONENT": _modules,
    "MODULE": _modules,
    "LANGUAGE": _languages,
    "RUN": _run_directories,
    "RUN_OR_LOG": _recordings,
    "LOG": _recordings,
    "A": _recordings,
    "B": _recordings,
    "FILE": _launch_files,
}
"""Metavar of a parameter to the source of its values. The shells add file names where a source gives none."""
_OF_COMMAND: dict[tuple[str, ...], Callable[[str | None], Iterable[str]]] = {
    ("call", "NAME"): of_runs.commands,
    ("send", "CHANNEL"): of_runs.open_channels,
    ("monitor", "NAME"): _templates,
    ("web", "NAME"): of_runs.names,
    ("new", "component", "KIND"): _kinds,
    ("new", "interface", "KIND"): _kinds_of_types,
    **{("new", what, "NAME"): _nothing for what in ("project", "component", "launch")},
    **{("remove", what, "NAME"): _nothing for what in ("reads", "writes", "serves", "calls", "setting")},
}
"""Words of a command and metavar to the source of its values, where those of the metavar alone do not fit."""
_IN_FILE: dict[str, Callable[[list[dict[str, Any]]], Iterable[str]]] = {
    "NAME": _components_of,
    "PATH=VALUE": _assignments_of,
    "NAME.SETTING": lambda rows: (each.rstrip("=") for each in _assignments_of(rows)),
}
"""Metavar of a parameter to what the settings of a typed launch file offer for it."""
