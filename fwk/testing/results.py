"""Files of an evaluation's results: written whole or not at all, read with care, and judged."""

import errno
import json
import os
import re
import stat
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, overload

from fwk.testing.executors import CampaignError

_UNKNOWN_TO_JSON = {"Infinity": "1e999", "-Infinity": "-1e999", "NaN": "null"}
"""Values that JSON lacks, as Python writes them, and their JSON: readers take `1e999` for infinity."""
_TEXT_OR_UNKNOWN = re.compile(r'"(?:[^"\\]|\\.)*"|-?Infinity|NaN')
_CURES = dict.fromkeys((errno.ENOSPC, errno.EDQUOT), "make room for it there, or ") | dict.fromkeys(
    (errno.EACCES, errno.EPERM), "allow yourself to write there, or "
)
_EMPTY: tuple[Any, ...] = ("", {}, [])
"""Values without a measurement."""


class FolderError(CampaignError):
    """A folder that cannot hold a campaign: it holds another one, or a file that is damaged or cannot be used."""


class Results(Sequence[Any]):
    """Results of runs, each read from its file when it is asked for: together they may fill the memory."""

    def __init__(self, files: Mapping[int, Path]) -> None:
        """Takes the file of each seed's result."""
        self.seeds = list(files)
        """Seed of each result."""
        self._files = list(files.values())

    def __len__(self) -> int:
        return len(self._files)

    @overload
    def __getitem__(self, index: int) -> Any: ...
    @overload
    def __getitem__(self, index: slice) -> "Results": ...
    def __getitem__(self, index: int | slice) -> Any:
        if isinstance(index, slice):
            return Results(dict(zip(self.seeds[index], self._files[index], strict=True)))
        return json.loads(self._files[index].read_text())


def text_of(result: Any) -> str:
    """Returns the text of a result, in plain JSON.

    Raises:
        CampaignError: it has no measurements.
        TypeError: it has values that JSON does not know.
    """
    if result in _EMPTY:
        raise CampaignError(f"the evaluation returned {result!r}, which has no measurements")
    text = json.dumps(result)
    return _TEXT_OR_UNKNOWN.sub(lambda found: _UNKNOWN_TO_JSON.get(found[0], found[0]), text)


def flaw_of(content: bytes, flaw_in: Callable[[Any], str] = lambda _: "") -> str:
    """Returns what is wrong with the content of a file, or with the value that it holds, or an empty text."""
    try:
        value = json.loads(content)
    except (ValueError, RecursionError) as error:
        return f"it is no JSON ({error})" if content else "it is empty"
    return "it says nothing" if value in _EMPTY else flaw_in(value)


def read_file(file: Path) -> bytes | None:
    """Returns the content of a file, or None if there is none.

    Raises:
        FolderError: the file cannot be read.
    """
    reason = "it is no file"
    try:
        kind = file.stat().st_mode
        if stat.S_ISREG(kind) or stat.S_ISDIR(kind):  # any other, such as a pipe or a device, may never end
            return file.read_bytes()
    except FileNotFoundError:
        if not file.is_symlink():
            return None
        reason = f"it is a link to {file.readlink()}, which does not exist"
    except OSError as error:
        reason = f"{error.strerror}"
    raise FolderError(f"{file} cannot be read: {reason}; move it away, or choose another folder")


def cure_of(error: OSError) -> str:
    """Returns what helps where a file cannot be written."""
    return f"{_CURES.get(error.errno or 0, '')}choose another folder"


def write_file(file: Path, text: str) -> None:
    """Writes a file in one step: it is whole or not there.

    Raises:
        FolderError: the file cannot be written.
    """
    partial = file.with_name(f".{file.stem}.{os.getpid()}")
    try:
        with open(partial, "w", encoding="utf-8") as opened:
            opened.write(text)
            opened.flush()
            os.fsync(opened.fileno())
        partial.replace(file)
    except OSError as error:
        raise FolderError(f"{file} cannot be written: {error.strerror}; {cure_of(error)}") from error
    finally:  # also after Ctrl-C in the middle
        with suppress(OSError):
            partial.unlink()
