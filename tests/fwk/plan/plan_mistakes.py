"""Runs a table of broken launch files: each row is a message and, under it, what is broken."""

from pathlib import Path
from textwrap import dedent
from typing import Any, NamedTuple

import pytest

from fwk.model.errors import PlanError
from fwk.plan.load import LaunchOptions, load_plan


class Broken(NamedTuple):
    """A row: all that the check says, one line a mistake, and the launch file `it.yaml` that it says it of.

    Lines such as `--- other.yaml` begin further files.
    """

    message: str
    text: str
    options: dict[str, Any] = {}


def rows(*broken: Broken) -> pytest.MarkDecorator:
    """The table as parameters of a test, each called by its message."""
    return pytest.mark.parametrize("broken", broken, ids=[row.message.strip()[:70] for row in broken])


def expected(broken: Broken) -> list[str]:
    """The lines of the row's message."""
    return dedent(broken.message).strip().splitlines()


def said(broken: Broken, folder: Path) -> list[str]:
    """What the check says of the row's files, written into `folder`."""
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
