"""Every command, option and make target that the documentation names exists."""

import re
import shlex
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest
import typer

from fwk.cli import commands
from fwk.cli.run import launch_command
from tests.docs.docs_pages import PAGES, ROOT, blocks, spans

_SHELL = {"sh", "console", "bash", ""}
_TARGET = re.compile(r"^([a-z-]+):", re.M)


@cache
def roots() -> dict[str, Any]:
    """Returns the two programs as click commands."""
    return {"fwk": typer.main.get_command(commands.app), "fwk-launch": typer.main.get_command(launch_command.app)}


def lines_of(page: Path) -> Iterator[str]:
    """Yields every command line in the code spans and shell blocks of a page."""
    yield from spans(page)
    for block in blocks(page):
        if block.language in _SHELL:
            for line in block.text.splitlines():
                yield from line.removeprefix("$ ").split(" && ")


def words_of(line: str) -> list[str]:
    try:
        return shlex.split(line, comments=True)
    except ValueError:
        return line.split()


def mistakes(line: str) -> list[str]:
    """Returns the parts of a command line that name something that does not exist."""
    words = words_of(line)
    if not words or words[0] not in ("fwk", "fwk-launch"):
        return []
    found, commands = [], [roots()[words[0]]]
    for word in words[1:]:
        groups = [command for command in commands if getattr(command, "commands", None)]
        if word.startswith("--"):
            name = word.partition("=")[0]
            if not any(name in options(command) for command in commands):
                found.append(f"'{line}' has no option {name}")
        elif groups and not word.startswith(("[", "-", "…", "...")) and word != "COMMAND":
            commands = []
            for name in word.split("|"):
                below = [group.commands[name] for group in groups if name in group.commands]
                if not below:
                    return [*found, f"'{line}' has no command {name}"]
                commands += below
    return found


def options(command: Any) -> set[str]:
    return {"--help", *(name for each in command.params for name in (*each.opts, *each.secondary_opts))}


@cache
def all_options(command: Any) -> set[str]:
    below = getattr(command, "commands", None) or {}
    return options(command).union(*(all_options(below[name]) for name in below))


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_and_their_options_exist(page: Path) -> None:
    assert not [mistake for line in lines_of(page) for mistake in mistakes(line)]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_options_alone_exist_somewhere(page: Path) -> None:
    known = set[str]().union(*(all_options(root) for root in roots().values()))
    named = {span.split()[0].partition("=")[0].rstrip(",") for span in spans(page) if span.startswith("--")}
    assert named <= known


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_make_targets_exist(page: Path) -> None:
    makefiles = [ROOT / "Makefile", *ROOT.glob("tools/**/*.mk")]
    targets = {name for makefile in makefiles for name in _TARGET.findall(makefile.read_text())}
    named = {word for line in lines_of(page) if line.startswith("make ") for word in words_of(line)[1:2]}
    assert named <= targets


@pytest.mark.parametrize(
    ("line", "n_mistakes"),
    [
        ("fwk check soccer.yaml --settings", 0),
        ("fwk chekc soccer.yaml", 1),
        ("fwk check soccer.yaml --setings", 1),
        ("fwk-launch soccer.yaml --ticks 1200 --tocks 7", 1),
        ("fwk start|stop|hop NAME", 1),
    ],
)
def test_a_misspelt_line_is_a_mistake(line: str, n_mistakes: int) -> None:
    assert len(mistakes(line)) == n_mistakes
