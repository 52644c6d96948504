"""Writes settings into the host file beside a launch file, all of them or none."""

import contextlib
import fcntl
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fwk.control.yaml_edit import EditError, read, with_value, without
from fwk.model.errors import Problems
from fwk.model.selection import matches
from fwk.plan.files.launch_file import shown
from fwk.plan.files.source import read_value

REFUSED_LATER = "the next run would refuse it, so nothing was set; it can be set for this run alone, without keeping it"
"""Follows the mistakes that settings would be in the files, such as one that other components do not share."""


@dataclass(frozen=True)
class Kept:
    """A setting of the host file."""

    component: str
    """Name or pattern of the component."""
    setting: str
    """Dotted name of the setting."""
    value: Any

    @classmethod
    def of(cls, typed: str) -> "Kept":
        """Makes a setting of `NAME.SETTING=VALUE`, which was checked already."""
        path, _, text = typed.partition("=")
        component, _, setting = path.partition(".")
        node = read_value(text, "", Problems())
        return cls(component, setting, node.plain() if node else None)


class KeepError(Exception):
    """The host file could not be changed and is unchanged; the text gives the reason."""


def keep(file: Path, settings: Sequence[Kept]) -> None:
    """Writes settings into the file, which is created if necessary.

    When this returns, they are on the disk; if the process is killed during the call, the file is the old or the new
    one.

    Raises:
        KeepError: not written; the file is unchanged.
    """

    def edit(text: str) -> str:
        for each in settings:
            text = with_value(text, ("config", each.component, *each.setting.split(".")), each.value)
            _check_wins(read(text)["config"], each)
        return text

    _rewrite(file, edit)


def forget(file: Path, paths: Sequence[str]) -> None:
    """Removes settings, `NAME.SETTING` each, from the file; removes a file that is then empty.

    Raises:
        KeepError: one of them is not in it, or it cannot be written; the file is unchanged.
    """

    def edit(text: str) -> str:
        for path in paths:
            component, _, setting = path.partition(".")
            try:
                text = without(text, ("config", component, *setting.split(".")))
            except EditError as error:
                raise EditError(str(error).replace("'config.", "'")) from error
        return text

    _rewrite(file, edit)


def _rewrite(file: Path, edit: Callable[[str], str]) -> None:
    file = file.resolve()
    try:
        if file.exists() and not file.is_file() and not file.is_dir():
            raise EditError("it is not an ordinary file; move it away")  # a pipe, or a device that would be replaced
        with _locked(file.parent) as folder:
            edited = edit(file.read_text(encoding="utf-8") if file.exists() else "")
            if edited.strip():
                _write(file, edited, folder)
            else:
                file.unlink(missing_ok=True)
                os.fsync(folder)
    except (EditError, UnicodeDecodeError) as error:
        raise KeepError(f"{shown(file)}: {error}") from error
    except OSError as error:
        raise KeepError(f"{shown(file)}: cannot be written: {error.strerror}; it is unchanged") from error


def _check_wins(config: dict[str, Any], kept: Kept) -> None:
    """Refuses a setting that a later entry of the file overrides: keeping it would have no effect."""
    names = list(config)
    for later in names[names.index(kept.component) + 1 :]:
        below = config[later]
        for key in kept.setting.split("."):
            below = below.get(key) if isinstance(below, dict) else None
        if matches(kept.component, later) and below is not None and below != kept.value:
            raise EditError(f"'{later}' further down sets {below} for '{kept.setting}' and wins; change it there")


@contextlib.contextmanager
def _locked(folder: Path) -> Iterator[int]:
    """Locks the folder for one writer; yields the descriptor of the folder."""
    descriptor = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield descriptor
    finally:
        os.close(descriptor)


def _write(file: Path, text: str, folder: int) -> None:
    new = file.with_name(f".{file.name}.new")
    try:
        with open(new, "w", encoding="utf-8") as opened:
            if file.exists():
                _like(opened.fileno(), file)
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        os.replace(new, file)
    except OSError:
        new.unlink(missing_ok=True)
        raise
    os.fsync(folder)


def _like(descriptor: int, file: Path) -> None:
    """Gives the new file the mode and owner of the file that it replaces."""
    old = file.stat()
    os.fchmod(descriptor, old.st_mode & 0o7777)
    with contextlib.suppress(PermissionError):
        os.fchown(descriptor, old.st_uid, old.st_gid)
