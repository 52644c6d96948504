"""Candidates from a recording that was typed before: components, channels, settings."""

from collections.abc import Callable, Iterable
from contextlib import redirect_stderr
from io import StringIO
from pathlib import Path
from typing import Any

RECORDING = ("RUN_OR_LOG", "LOG", "LOG...", "A")
"""Metavars of parameters that name a recording."""


def plan_of(word: str) -> dict[str, Any]:
    """Returns the plan of a recording, as plain data, and makes its message types available; empty: it has none.

    Raises:
        LogError: there is no such recording, or it cannot be read.
    """
    from fwk.cli.recordings.find_log import located
    from fwk.cli.recordings.user_folders import plan_document, use_types_of_run

    with redirect_stderr(StringIO()):  # parts that are missing
        log, _ = located(Path(word))
    use_types_of_run(log, Path())
    return plan_document(log)


def _components(plan: dict[str, Any]) -> Iterable[str]:
    return (each["name"] for each in plan.get("components", ()))


def _channels(plan: dict[str, Any]) -> Iterable[str]:
    return types_in(plan)


def _settings(plan: dict[str, Any]) -> Iterable[str]:
    return (f"{each['name']}.{setting}=" for each in plan.get("components", ()) for setting in each["origins"])


def types_in(plan: dict[str, Any]) -> dict[str, str]:
    """Returns the types of the channels of a plan."""
    return {each["name"]: each["type_name"] for each in plan.get("channels", ())}


SOURCES: dict[str, Callable[[dict[str, Any]], Iterable[str]]] = {
    "NAME": _components,
    "PATTERN": _channels,
    "CHANNEL": _channels,
    "PATH=VALUE": _settings,
    "NAME=MODULE:CLASS": lambda plan: (f"{each}=" for each in _components(plan)),
    "A=B": lambda plan: (f"{each}=" for each in _channels(plan)),
}
"""Metavar of a parameter to its values in the plan of a recording."""
