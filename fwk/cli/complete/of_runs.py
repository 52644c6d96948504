"""Candidates from live runs: the named one, or all if several go on and none is named."""

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

from fwk.control import runs
from fwk.control.client import Client, ControlError, RefusedError
from fwk.model.service_channels import is_of_service, service_of

_TIMEOUT_S = 3.0  # a busy machine answers slowly


def components(chosen: str | None) -> Iterable[str]:
    """Returns the components of the run."""
    return (row["name"] for row in _asked(runs.supervisor, chosen, "status", "components"))


def settings(chosen: str | None) -> Iterable[str]:
    """Returns the settings of the run as `NAME.SETTING`."""
    rows = _asked(runs.supervisor, chosen, "settings", "settings")
    return (f"{row['component']}.{row['setting']}" for row in rows)


def assignments(chosen: str | None) -> Iterable[str]:
    """Returns the settings of the run as `NAME.SETTING=`."""
    return (f"{path}=" for path in settings(chosen))


def channels(chosen: str | None) -> Iterable[str]:
    """Returns the channels of the run."""
    return (row["channel"] for row in _rows(chosen))


def open_channels(chosen: str | None) -> Iterable[str]:
    """Returns the channels that programs outside may write."""
    return (row["channel"] for row in _rows(chosen) if row["outside"])


def commands(chosen: str | None) -> Iterable[str]:
    """Returns the services and commands of the run."""
    return (service_of(each) for each in channels(chosen) if is_of_service(each))


def types(chosen: str | None) -> dict[str, str]:
    """Returns the types of the channels of the run, and makes them available."""
    from fwk.lcm.type_registry import use_types_of

    for folder in _asked(runs.supervisor, chosen, "run", "folders"):
        use_types_of(Path(folder))
    return {row["channel"]: row["type"] for row in _rows(chosen)}


def names(_: str | None) -> Iterable[str]:
    """Returns the names of all runs, or their ports."""
    return (str(run.get("name") or port) for port, run in runs.look().items())


def _rows(chosen: str | None) -> Iterator[dict[str, Any]]:
    return _asked(runs.gateway, chosen, "channels", "channels")


def _asked(connect: Callable[[str | int | None], Client], chosen: str | None, verb: str, key: str) -> Iterator[Any]:
    """Yields a list that the run answers with; those of all runs if none is named and several can be meant.

    Raises:
        ControlError: no run, or no answer.
    """
    try:
        with connect(chosen) as run:
            yield from run.ask(verb, _TIMEOUT_S)[key]
    except RefusedError:
        if chosen is not None or os.environ.get(runs.RUN_VARIABLE):
            raise
        for port in runs.meant():
            with suppress(ControlError), connect(port) as run:
                yield from run.ask(verb, _TIMEOUT_S)[key]
