"""The pages for newcomers refer to things that exist."""

import re
from pathlib import Path
from typing import Any

import pytest
from typer.main import get_command

from fwk.cli import commands
from fwk.cli.run import launch_command

ROOT = Path(__file__).parents[3]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
_TYPED = re.compile(r"`(fwk(?:-launch)? [^`]+)`|^(?:\$ )?(fwk(?:-launch)? [^`\n]+)$", re.M)
_OPTION = re.compile(r"(?<!\S)-{1,2}[a-z][a-z-]*")
_LINK = re.compile(r"\]\(([^)#:]+)\)")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_to_a_file(page: Path) -> None:
    broken = [link for link in _LINK.findall(page.read_text()) if not (page.parent / link).exists()]
    assert not broken


def test_make_targets_of_the_readme_exist() -> None:
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(), re.M))
    named = set(re.findall(r"make ([a-z-]+)", (ROOT / "README.md").read_text()))
    assert {"soccer", "test"} <= named
    assert named <= targets


def test_launch_files_of_the_readme_exist() -> None:
    named = set(re.findall(r"[\w-]+\.yaml", (ROOT / "README.md").read_text()))
    assert named
    assert all((ROOT / "launch" / name).is_file() for name in named)


def command_of(words: list[str]) -> Any:
    """Returns the command that the words begin with, or one of its groups."""
    found: Any = get_command(launch_command.app if words[0] == "fwk-launch" else commands.app)
    for word in words[1:]:
        below = getattr(found, "commands", {})
        if word not in below:
            return found
        found = below[word]
    return found


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_printed_command_exists_with_its_options(page: Path) -> None:
    for typed in ("".join(groups) for groups in _TYPED.findall(page.read_text())):
        found = command_of(typed.split())
        assert not getattr(found, "commands", {}) or len(typed.split()) == 2, f"there is no '{typed}'"
        known = {option for each in found.params for option in (*each.opts, *each.secondary_opts)}
        unknown = set(_OPTION.findall(typed)) - known
        assert not unknown, f"'{typed}': no {', '.join(unknown)}"
