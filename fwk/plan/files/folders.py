"""Makes the folders of a launch file importable and generates the classes of their .lcm files."""

import importlib
import re
import sys
from collections.abc import Sequence
from pathlib import Path

from fwk.lcm.type_registry import put_first
from fwk.lcm.typegen import TypeGenerationError, generate
from fwk.model.errors import Problems
from fwk.plan.files.launch_file import FOLDER, INSTALLED, shown
from fwk.plan.packages import component_packages

_PACKAGE = re.compile(r"^\s*package\s+([\w.]+)\s*;", re.M)


def folders_of(launch_folders: Sequence[Path]) -> tuple[str, ...]:
    """Returns the folders that are searched for modules and .lcm files, besides the installed ones.

    These are the folder of each launch file, and its parent folder if the folder is called `launch` or if the parent
    has a folder `lcmtypes` or one named like an installed package of components.
    """
    parts = ("lcmtypes", *component_packages())
    found = [
        folder
        for beside in launch_folders
        for folder in (beside, beside.parent)
        if folder == beside or beside.name == FOLDER or any((folder / part).is_dir() for part in parts)
    ]
    return tuple(str(folder) for folder in dict.fromkeys(found) if folder not in (INSTALLED, INSTALLED / FOLDER))


def join(folders: Sequence[str], problems: Problems) -> None:
    """Puts folders on the module search path, before the installed ones, and generates their types."""
    put_first(folders)
    for folder in folders:
        types = Path(folder) / "lcmtypes"
        for source in sorted(types.glob("*.lcm")):
            _check_package(source, problems)
        try:
            generate(types)
        except TypeGenerationError as error:
            _tell(str(error), problems)
        except OSError as error:
            problems.add(shown(types), "", f"cannot write Python classes there: {error.strerror}")
    importlib.invalidate_caches()


def _tell(mistakes: str, problems: Problems) -> None:
    """Reports the lines of a `TypeGenerationError`, each of the form `FILE:LINE: mistake`."""
    for mistake in mistakes.splitlines():
        place, _, reason = mistake.partition(": ")
        file, _, line = place.rpartition(":")
        problems.add(f"{shown(Path(file))}:{line}" if file else shown(Path(place)), "", reason)


def _check_package(source: Path, problems: Problems) -> None:
    """Refuses a package of types in two folders, because Python would find only one of them."""
    text = source.read_text(encoding="utf-8", errors="replace")
    package = _PACKAGE.search(text)
    for entry in sys.path:
        other = (Path(entry) / "lcmtypes").absolute()
        if not package or other == source.parent or not (other / package[1]).is_dir():
            continue
        same = other / source.name
        if not same.is_file() or same.read_text(encoding="utf-8", errors="replace") != text:
            line = text[: package.start(1)].count("\n") + 1
            taken = f"the package '{package[1]}' is used by {shown(other)}; give these types another package"
            problems.add(f"{shown(source)}:{line}", "", taken)
