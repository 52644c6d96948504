"""The page about soccer names every launch file, and every component in the row of its folder."""

import ast
import re
from pathlib import Path

import pytest

from tests.docs.docs_pages import ROOT

PAGE = (ROOT / "docs" / "soccer.md").read_text()
FOLDERS = sorted(folder for folder in (ROOT / "procs").iterdir() if list(folder.glob("*.py")))


def components(folder: Path) -> set[str]:
    """Returns the names of the modules of a folder that hold a component."""
    return {file.stem for file in folder.glob("*.py") if any(map(is_component, ast.parse(file.read_text()).body))}


def is_component(node: ast.stmt) -> bool:
    """Returns whether a class is a component that a launch file can use, so no abstract one."""
    bases = {base.id for base in node.bases if isinstance(base, ast.Name)} if isinstance(node, ast.ClassDef) else set()
    return bool(bases & {"Component", "Detector"}) and "ABC" not in bases


@pytest.mark.parametrize("folder", FOLDERS, ids=lambda folder: folder.name)
def test_row_of_a_folder_names_its_components(folder: Path) -> None:
    row = re.search(rf"^\| `procs/{folder.name}` \|.*$", PAGE, re.MULTILINE)
    assert row, f"docs/soccer.md: the table of folders has no row for procs/{folder.name}"
    named = set(re.findall(r"`(\w+)`", row[0].rsplit("|", 2)[1]))
    assert named == components(folder)


def test_every_launch_file_is_named() -> None:
    assert not [file.name for file in (ROOT / "launch").glob("*.yaml") if f"`{file.name}`" not in PAGE]
