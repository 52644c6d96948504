"""Finds a launch file, its includes and its host file, and reads them into layers."""

import os
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import TypeVar

import fwk
from fwk.model.errors import Problems, there
from fwk.plan.files.schema import HostFile, LaunchFile
from fwk.plan.files.source import Node, read_yaml
from fwk.plan.files.validation import Path as NodePath
from fwk.plan.files.validation import validated

INSTALLED = Path(fwk.__file__).resolve().parent.parent
"""Folder of `fwk`, `lcmtypes`, `launch` and packages of components: site-packages, or a checkout."""
FOLDER = "launch"
HOST_SUFFIX = ".host.yaml"

F = TypeVar("F", bound=HostFile)


@dataclass(frozen=True)
class Layer:
    """The content of one file, with the places of its values."""

    path: Path
    content: LaunchFile
    node: Node


@dataclass
class Files:
    """All files of a launch; later ones win: included before including files, the host file last."""

    path: Path
    layers: list[Layer] = field(default_factory=list)
    folders: list[Path] = field(default_factory=list)
    """Folders of the launch files."""
    gaps: set[str] = field(default_factory=set)
    """Namespaces in which a reported mistake may hide components; `*`: all namespaces."""

    def may_hide(self, name: str) -> bool:
        """Returns whether a component or channel may be missing only because of a reported mistake."""
        return "*" in self.gaps or name.rpartition("/")[0] in self.gaps


def shown(path: Path) -> str:
    """Returns a path as it is shown: relative to the working directory if it is below."""
    absolute = path.absolute()
    return str(absolute.relative_to(Path.cwd())) if absolute.is_relative_to(Path.cwd()) else str(absolute)


def host_file(launch_file: Path) -> Path:
    """Returns the path of the host file of a launch file: `robot.host.yaml` beside `robot.yaml`."""
    return launch_file.with_name(launch_file.stem + HOST_SUFFIX)


def find_launch_file(file: str, problems: Problems) -> Path | None:
    """Finds a launch file: as given, then in `launch/`, then among those that come with fwk."""
    places = [Path(), Path(FOLDER), INSTALLED / FOLDER]
    for place in places:
        if os.path.isfile(place / file):  # also False for impossible and forbidden paths
            return (place / file).absolute()
    for place in places:
        if os.path.exists(place / file) and not os.path.isdir(place / file):
            problems.add(shown(place / file), "", "cannot be read: it is not an ordinary file")
            return None
    found = list(dict.fromkeys(name for place in places[1:] for name in _launch_files(place)))
    near = get_close_matches(file, found, 1)
    listed = f"{there(found)} {', '.join(found)}" if found else "there is none in launch/"
    problems.add(file, "", f"no such launch file; {f'did you mean {near[0]!r}? ' if near else ''}{listed}")
    return None


def _launch_files(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("*.yaml") if path.is_file() and not path.name.endswith(HOST_SUFFIX))


def read_files(path: Path, problems: Problems) -> Files:
    """Reads a launch file with everything that it includes, and its host file."""
    files = Files(path)
    _Reader(files, problems).read(path, [])
    beside = host_file(path)
    node = read_yaml(beside, shown(beside), problems) if os.path.isfile(beside) else None
    if node:
        lay_over(files, beside, node, problems)
    return files


def lay_over(files: Files, path: Path, node: Node, problems: Problems) -> None:
    """Adds a layer on top, with the keys of a host file."""
    checked = _checked(HostFile, node, files, problems)
    if checked:
        content, node = checked
        given = {name: getattr(content, name) for name in content.model_fields_set}
        files.layers.append(Layer(path, LaunchFile.model_construct(**given), node))


class _Reader:
    def __init__(self, files: Files, problems: Problems) -> None:
        self._files = files
        self._problems = problems
        self._read: set[Path] = set()

    def read(self, path: Path, above: list[Path]) -> None:
        """Reads a file that the files `above` include, each including the next."""
        path = path.resolve()
        if path in self._read:
            return
        self._read.add(path)
        node = read_yaml(path, shown(path), self._problems)
        checked = _checked(LaunchFile, node, self._files, self._problems) if node else None
        if checked is None:
            self._files.gaps.add("*")
            return
        content, node = checked
        for number, name in enumerate(content.include):
            self._include(name, node.at("include", number).place, [*above, path])
        self._files.layers.append(Layer(path, content, node))
        self._files.folders.append(path.parent)

    def _include(self, name: str, place: str, above: list[Path]) -> None:
        here = above[-1].parent
        found = next((folder / name for folder in (here, INSTALLED / FOLDER) if os.path.isfile(folder / name)), None)
        if found is None:
            there = [*_launch_files(here), *_launch_files(INSTALLED / FOLDER)]
            near = get_close_matches(name, there, 1)
            right = f"did you mean '{near[0]}'?" if near else f"it would have to be in {shown(here)}/"
            self._problems.add(place, "", f"there is no '{name}' to include; {right}")
            self._files.gaps.add("*")
        elif found.resolve() in above:
            ring = [*above[above.index(found.resolve()) :], found]
            text = f"files include each other in a cycle: {' -> '.join(path.name for path in ring)}; leave one out"
            self._problems.add(place, "", text)
        else:
            self.read(found, above)


def _checked(model: type[F], node: Node, files: Files, problems: Problems) -> tuple[F, Node] | None:
    """Returns the content of a file without values that do not fit, which are reported."""

    def report(path: NodePath, place: str, text: str) -> None:
        problems.add(place, "", text)
        files.gaps |= _gap(path)

    return validated(model, node, report, "key")


def _gap(path: NodePath) -> set[str]:
    """Returns the namespaces that lack a component if the value at a path is left out."""
    if not path:
        return {"*"}
    if path[-1] == "use":
        return _gap(path[:-1])
    if path[0] in ("components", "robots") and len(path) == 2:
        return {str(path[1]).rpartition("/")[0] if path[0] == "components" else str(path[1])}
    return (
        {"*"}
        if len(path) <= {"templates": 3, "components": 1, "robots": 1, "include": 2}.get(str(path[0]), 0)
        else set()
    )
