"""Run directories: creates, lists and prunes them."""

import contextlib
import fcntl
import os
import re
import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from fwk.clock import US_PER_S, wall_us

RUNS = Path(".cache", "fwk", "runs")
"""Below the home folder."""
IN_USE = "in-use"
"""File in a run directory, locked by every process of the run."""
GB = 1_000_000_000
KEEP = "keep"
"""File that protects a run directory from automatic removal."""
_LETTERS_MAX = 50
"""Letters of a run's name that its directory has at most: names of files have 255 bytes."""
_NAME = re.compile(r"\d{4}-\d\d-\d\dT\d\d-\d\d-\d\d-(.+)-\d+", re.ASCII)


class RunDirError(Exception):
    """A run directory cannot be created; the text names the folder and the reason."""


@dataclass(frozen=True)
class RunDir:
    """Run directory with its size and state."""

    path: Path
    size_bytes: int
    in_use: bool
    kept: bool


def make_run_dir(name: str, runs: Path | None = None) -> Path:
    """Creates `<date-time>-<name>-<pid>` in `runs`, by default `~/.cache/fwk/runs`; in use until this process and all
    its descendants have ended.

    Raises:
        RunDirError: the folder cannot be created.
    """
    when = datetime.fromtimestamp(wall_us() / US_PER_S, UTC).astimezone().strftime("%Y-%m-%dT%H-%M-%S")
    word = re.sub(r"[^\w.-]+", "_", name)[:_LETTERS_MAX] or "run"
    parent = runs or Path.home() / RUNS
    folder = parent / f"{when}-{word}-{os.getpid()}"
    try:
        parent.mkdir(parents=True, exist_ok=True)
        with _alone(parent):
            folder.mkdir(exist_ok=True)
            lock = os.open(folder / IN_USE, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o644)
            fcntl.flock(lock, fcntl.LOCK_SH)
    except OSError as error:
        raise RunDirError(f"{folder}: cannot create the run directory there: {error.strerror}") from error
    return folder


def run_dirs(runs: Path) -> list[RunDir]:
    """Returns all run directories, the oldest first; folders with other names are ignored."""
    found = [path for path in runs.glob("*") if _NAME.fullmatch(path.name) and path.is_dir() and not path.is_symlink()]
    found.sort(key=lambda path: path.name)
    return [RunDir(path, _size(path), in_use(path), (path / KEEP).exists()) for path in found]


def prune(runs: Path, keep: int, max_bytes: int) -> list[RunDir]:
    """Removes the oldest run directories until there are at most `keep`, of that size together; 0: any.

    The newest run directory, those in use and those with a `keep` file stay; they count.
    """
    removed = []
    with _alone(runs):
        there = run_dirs(runs)
        number, size = len(there), sum(each.size_bytes for each in there)
        for each in there[:-1]:
            if not (keep and number > keep) and not (max_bytes and size > max_bytes):
                break
            if each.in_use or each.kept:
                continue
            shutil.rmtree(each.path, ignore_errors=True)
            if not each.path.exists():
                removed.append(each)
                number, size = number - 1, size - each.size_bytes
    return removed


@contextlib.contextmanager
def _alone(folder: Path) -> Iterator[None]:
    """Prevents other processes from creating and removing run directories in the meantime."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def named(path: Path) -> Path:
    """Returns the run directory of a name from `fwk runs list`, or the newest one of a run's own name (`--run NAME`),
    unless the path exists as typed.
    """
    if str(path) != path.name or os.path.lexists(path):
        return path
    return called(path.name, (Path.home() / RUNS).glob("*")) or path


def called(name: str, folders: Iterable[Path]) -> Path | None:
    """Returns the run directory of a name, or the newest one of a run's own name; None if there is neither."""
    own = []
    for folder in folders:
        if folder.name == name and folder.is_dir():
            return folder
        if own_name(folder.name) == name:
            own.append(folder)
    return max(own, default=None)


def own_name(folder: str) -> str:
    """Returns the own name of the run of a run directory; empty if the folder has another kind of name."""
    found = _NAME.fullmatch(folder)
    return found[1] if found else ""


def in_use(path: Path) -> bool:
    """Tells whether a process of the run is alive."""
    try:
        descriptor = os.open(path / IN_USE, os.O_RDWR)
    except OSError:
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return True
    finally:
        os.close(descriptor)
    return False


def _size(path: Path) -> int:
    total = 0
    for folder, _, files in os.walk(path):
        for file in files:
            with contextlib.suppress(OSError):
                total += os.lstat(os.path.join(folder, file)).st_size
    return total
