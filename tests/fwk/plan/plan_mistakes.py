"""Runs a table of broken launch files: each row is a message followed by the broken file."""

from pathlib import Path
from textwrap import dedent
from typing import Any, NamedTuple

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan


class Broken(NamedTuple):
    """A row: the lines that the check prints, one for each mistake, and the launch file `it.yaml` they refer to.

    Lines such as `--- other.yaml` begin further files.
    """

    message: str
    text: str
    options: dict[str, Any] = {}


def rows(*broken: Broken) -> pytest.MarkDecorator:
    """Returns the rows of a table as parameters of a test, each named by its message."""
    return pytest.mark.parametrize("broken", broken, ids=[row.message.strip()[:70] for row in broken])


def expected(broken: Broken) -> list[str]:
    """Returns the lines of the row's message."""
    return dedent(broken.message).strip().splitlines()


def said(broken: Broken, folder: Path) -> list[str]:
    """Returns what the check prints about the row's files, written into `folder`."""
    write(broken, folder)
    with pytest.raises(PlanError) as caught:
        load_plan("it.yaml", LaunchOptions(**broken.options))
    return str(caught.value).replace(f"{folder}/", "").splitlines()


def write(broken: Broken, folder: Path) -> None:
    """Writes the row's files."""
    name, files = "it.yaml", dict[str, list[str]]()
    for line in dedent(broken.text).strip("\n").split("\n"):
        if line.startswith("--- "):
            name = line[4:]
            files[name] = []
        else:
            files.setdefault(name, []).append(line)
    for file, lines in files.items():
        (folder / file).parent.mkdir(parents=True, exist_ok=True)
        (folder / file).write_text("\n".join(lines))
