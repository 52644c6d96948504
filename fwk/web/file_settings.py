"""Settings as the launch files have them, read by a child process: the files and the code may have been edited."""

import json
from collections.abc import Sequence
from typing import Any

from fwk.control.client import RefusedError
from fwk.control.host_file import REFUSED_LATER
from fwk.web.job import Job

Values = dict[tuple[str, str], Any]
"""Value by component and setting."""


async def values_in_file(file: str) -> Values:
    """Returns the settings that a run of this launch file would have now.

    Raises:
        RefusedError: the file has mistakes, which are named.
    """
    told: list[str] = []
    if await Job(["fwk", "config", "list", "--file", file, "--json"], told.append).run():
        raise RefusedError("".join(told).strip() or f"{file}: cannot be read")
    return {(row["component"], row["setting"]): row["value"] for row in json.loads("".join(told))}


async def check_kept(file: str, changes: Sequence[str]) -> None:
    """Checks that a launch file can have settings, `NAME.SETTING=VALUE` each, which a run has taken.

    Raises:
        RefusedError: it cannot; the mistakes are named.
    """
    told: list[str] = []
    sets = [word for each in changes for word in ("--set", each)]
    if await Job(["fwk", "check", file, *sets], told.append).run():
        raise RefusedError(f"{''.join(told).strip()}\n{REFUSED_LATER}")


def differing(rows: Sequence[dict[str, Any]], values: Values) -> list[dict[str, Any]]:
    """Returns the settings of a run that differ from the launch files, each with the value `in_file`."""
    found = []
    for row in rows:
        key = row["component"], row["setting"]
        if key in values and values[key] != row["value"]:
            found.append({**row, "in_file": values[key]})
    return found
