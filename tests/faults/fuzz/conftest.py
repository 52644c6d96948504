"""Builds each typer application once: thousands of command lines are tried, and building takes longer than trying."""

from collections.abc import Iterator
from functools import cache

import pytest
from typer.main import get_command


@pytest.fixture(scope="session", autouse=True)
def built_once() -> Iterator[None]:
    """Lets typer's `CliRunner` build the command of an application only the first time."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("typer.testing._get_command", cache(get_command))
        yield
