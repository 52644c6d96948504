"""The application's own words in display and summary: a headline and closing lines made of the newest messages."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

Newest = Callable[[str], Any]
"""Channel to its newest message, decoded, or None before the first."""


class Scoreboard:
    """Calls the plan's `module:function` for the headline, and `summary` of the same module for the closing lines.

    The module names the channels that it needs in `CHANNELS`, as patterns.

    A scoreboard that fails says so in the headline; it is decoration and stops nothing.
    """

    def __init__(self, name: str) -> None:
        self._module, _, self._function = name.partition(":")

    def headline(self, newest: Newest) -> str:
        """One line for the top of the display; empty without a scoreboard."""
        if not self._module:
            return ""
        try:
            return str(getattr(import_module(self._module), self._function)(newest))
        except Exception as error:
            return f"scoreboard {self._module}:{self._function}: {type(error).__name__}: {error}"

    def summary(self, newest: Newest) -> list[str]:
        """Closing lines; the headline if the module has no `summary`."""
        if not self._module:
            return []
        try:
            lines = getattr(import_module(self._module), "summary", None)
            return [str(line) for line in lines(newest)] if lines else [self.headline(newest)]
        except Exception as error:
            return [f"scoreboard {self._module}: {type(error).__name__}: {error}"]
