"""Scripts of `fwk monitor`: a Python file that names channels and has a function for their messages."""

import runpy
import traceback
from collections.abc import Callable, Sequence
from fnmatch import fnmatchcase
from importlib.resources import files
from pathlib import Path
from typing import Any

from fwk.lcm.type_registry import decoded, types_of

_TEMPLATES = files("fwk.monitor") / "templates"


class ScriptError(Exception):
    """A script cannot be used, or fails; the text names its file, and the message if there is one."""


class Script:
    """A script of the user: `channels`, a function `message`, and perhaps a function `end`.

    Args:
        file: the script; it is executed once.

    Raises:
        ScriptError: it cannot be read, fails, or lacks `channels` or `message`.
    """

    def __init__(self, file: Path) -> None:
        self._file = file
        try:
            made = runpy.run_path(str(file))
        except OSError as error:
            raise ScriptError(f"{file}: cannot be read: {error.strerror}") from error
        except Exception as error:
            raise ScriptError(_failure(file, error)) from error
        self.channels: Sequence[str] = made.get("channels", "")
        """Channels, or patterns of them."""
        self._message: Any = made.get("message")
        self._end: Callable[[], object] = made.get("end", lambda: None)
        named = not isinstance(self.channels, str) and all(isinstance(each, str) for each in self.channels)
        if not self.channels or not named or not callable(self._message):
            raise ScriptError(
                f"{file}: lacks 'channels', a tuple of channels or patterns such as ('*/imu',), or a function "
                "'message(channel, message, time_us)'; 'fwk monitor --template' prints an example"
            )

    def hear(self, channel: str, data: bytes, time_us: int) -> bool:
        """Gives a message to the script; returns whether the script wanted it.

        Raises:
            ScriptError: the script fails, or no type fits to the message.
        """
        if not any(fnmatchcase(channel, pattern) for pattern in self.channels):
            return False
        if not types_of(data):
            raise ScriptError(
                f"{self._file}: {channel}: a message of an unknown type (fingerprint {data[:8].hex()}); name the "
                "folder with its lcmtypes/ by --types"
            )
        try:
            self._message(channel, decoded(data), time_us)
        except Exception as error:
            raise ScriptError(f"{_failure(self._file, error)} ({channel} at {time_us} us)") from error
        return True

    def end(self) -> None:
        """Calls `end` of the script, if it has one.

        Raises:
            ScriptError: it fails.
        """
        try:
            self._end()
        except Exception as error:
            raise ScriptError(_failure(self._file, error)) from error


def templates() -> dict[str, str]:
    """Returns the text of each template by its name."""
    found = sorted((each for each in _TEMPLATES.iterdir() if each.name.endswith(".py")), key=lambda each: each.name)
    return {each.name.removesuffix(".py"): each.read_text() for each in found}


def _failure(file: Path, error: Exception) -> str:
    """Describes an exception with the line of the script that it comes from."""
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(file)]
    line = error.lineno if isinstance(error, SyntaxError) else lines[-1] if lines else None
    return f"{file}{f':{line}' if line else ''}: {type(error).__name__}: {error}"
