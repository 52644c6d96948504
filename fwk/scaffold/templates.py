"""Templates of projects and components: real files, in which `thing` stands for the name.

`Thing` stands for the name as a class, and `things` for the package of components.
"""

import ast
import re
from pathlib import Path
from typing import NamedTuple

import yaml

from fwk.component.component import Component

_FOLDER = Path(__file__).with_name("templates")
_PROJECT = "project"
_LAUNCH, _README = "launch.yaml", "README.md"
_RENAMED = {"gitignore": ".gitignore", "project.toml": "pyproject.toml"}
"""Files that tools would obey in the folder of the templates: name there to name in the project."""
_WORD = re.compile(r"(?<![A-Za-z0-9])(things?)(?![A-Za-z0-9])|(?<![A-Za-z])(Thing)(?![a-z])")
_NAMESPACE = "robot"


class ComponentTemplate(NamedTuple):
    """Filled template of a component."""

    files: dict[str, str]
    """Contents by path below the project."""
    launch: dict[str, dict[str, object]]
    """Entries for the launch file: section to name to value."""
    readme: list[str]
    """Lines for the table of components in the README."""


def kinds() -> list[str]:
    """Returns the kinds of components that have a template; `stages`, the plain one, comes first."""
    found = sorted(each.name for each in _FOLDER.iterdir() if each.is_dir() and each.name != _PROJECT)
    return sorted(found, key=lambda kind: kind != "stages")


def class_name(name: str) -> str:
    """Returns the class name for a name: `ball_tracker` becomes `BallTracker`."""
    return "".join(part.capitalize() for part in name.split("_"))


def names_in(kind: str) -> set[str]:
    """Returns the names that the classes of a kind of component use: attributes, methods and imports."""
    found = set(dir(Component))
    for path in sorted((_FOLDER / kind / "things").glob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, (ast.Import, ast.ImportFrom)):
                found |= {each.asname or each.name for each in node.names}
            elif isinstance(node, ast.FunctionDef):
                found.add(node.name)
            elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
                found.add(node.target.id)
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id == "self":
                found.add(node.attr)
    return {each for each in found if not _WORD.search(each)}


def project_files(name: str, package: str) -> dict[str, str]:
    """Returns the files of a new project by path."""
    return _filled_files(_PROJECT, name, package)


def component_template(kind: str, name: str, package: str, namespace: str) -> ComponentTemplate:
    """Returns the template of a component, filled."""
    files = _filled_files(kind, name, package)
    launch, readme = files.pop(_LAUNCH), files.pop(_README)
    entries = yaml.safe_load(launch.replace(f"{_NAMESPACE}/", f"{namespace}/"))
    return ComponentTemplate(files, entries, readme.splitlines())


def _filled_files(kind: str, name: str, package: str) -> dict[str, str]:
    folder, words = _FOLDER / kind, {"thing": name, "Thing": class_name(name), "things": package}
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            place = _filled(path.relative_to(folder).as_posix(), words)
            found[_RENAMED.get(place, place)] = _filled(path.read_text(encoding="utf-8"), words)
    return found


def _filled(text: str, words: dict[str, str]) -> str:
    return _WORD.sub(lambda found: words[found[0]], text)
