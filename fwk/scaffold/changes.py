"""Changes to the files of a project: collected first, then shown or written together."""

import difflib
import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from fwk.plan.files.launch_file import shown


class ScaffoldError(Exception):
    """A request of the generator cannot be carried out; the text gives the reason and what would be right."""


@dataclass(frozen=True)
class Change:
    """One file before and after."""

    path: Path
    after: str
    before: str | None = None
    """Content of a file that is edited; None for a file that is made."""

    def diff(self) -> str:
        """Returns the change as a unified diff."""
        name = shown(self.path)
        before = (self.before or "").splitlines(keepends=True)
        return "".join(difflib.unified_diff(before, self.after.splitlines(keepends=True), name, name))


def edited(path: Path, after: str) -> Change:
    """Returns the change of an existing file."""
    return Change(path, after, content(path))


def content(path: Path) -> str:
    """Returns the text of a file with its own line ends.

    Raises:
        ScaffoldError: the file cannot be read.
    """
    try:
        with open(path, encoding="utf-8", newline="") as file:
            return file.read()
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "not UTF-8"
        raise ScaffoldError(f"{shown(path)}: cannot be read: {reason}") from error


def pending(changes: Sequence[Change]) -> list[Change]:
    """Returns the changes without those whose file already has the content."""
    return [each for each in changes if not (each.path.is_file() and content(each.path) == each.after)]


def refuse_overwriting(changes: Sequence[Change]) -> None:
    """Checks that no file that is to be made exists with another content.

    Raises:
        ScaffoldError: the files that exist.
    """
    taken = [shown(each.path) for each in pending(changes) if each.before is None and os.path.lexists(each.path)]
    if taken:
        plural = "exist" if len(taken) > 1 else "exists"
        raise ScaffoldError(f"{', '.join(taken)}: {plural} already; overwrite with --force, or choose another name")


def write(changes: Sequence[Change]) -> None:
    """Writes all files; each is replaced as a whole and keeps its permissions."""
    for each in changes:
        each.path.parent.mkdir(parents=True, exist_ok=True)
        made = each.path.with_name(f".{each.path.name}.new")
        with open(made, "w", encoding="utf-8", newline="") as file:
            file.write(each.after)
        if each.path.exists():
            made.chmod(each.path.stat().st_mode)
        made.replace(each.path)
