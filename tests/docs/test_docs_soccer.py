"""The page about soccer names every launch file, and every component in the row of its folder."""

import ast
import re
from pathlib import Path

import pytest

from tests.docs.docs_pages import ROOT

PAGE = (ROOT / "docs" / "soccer.md").read_text()
BASES = {"Component", "Detector"}
FOLDERS = sorted(folder for folder in (ROOT / "procs").iterdir() if list(folder.glob("*.py")))


def components(folder: Path) -> set[str]:
    """Returns the names of the modules of a folder that hold a component."""
    sources = {file.stem: file.read_text() for file in folder.glob("*.py")}
    parsed = {name: ast.parse(source) for name, source in sources.items() if any(base in source for base in BASES)}
    return {name for name, tree in parsed.items() if any(map(is_component, tree.body))}


def is_component(node: ast.stmt) -> bool:
    """Returns whether a class is a component that a launch file can use, so no abstract one."""
    bases = {base.id for base in node.bases if isinstance(base, ast.Name)} if isinstance(node, ast.ClassDef) else set()
    return bool(bases & BASES) and "ABC" not in bases


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_row_of_a_folder_names_its_components(folder: Path) -> None:
    row = re.search(rf"^\| `procs/{folder.name}` \|.*$", PAGE, re.MULTILINE)
    assert row, f"docs/soccer.md: the table of folders has no row for procs/{folder.name}"
    named = set(re.findall(r"`(\w+)`", row[0].rsplit("|", 2)[1]))
    assert named == components(folder)


def test_every_launch_file_is_named() -> None:
    assert not [file.name for file in (ROOT / "launch").glob("*.yaml") if f"`{file.name}`" not in PAGE]
