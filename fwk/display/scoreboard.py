"""Headline, drawing and summary of the application, made of the newest messages."""

from collections.abc import Callable
from importlib import import_module
from typing import Any

Newest = Callable[[str], Any]
"""Channel to its newest message, decoded, or None before the first."""
Drawing = list[list[tuple[str, str]]]
"""Lines of a drawing; each is a list of texts with their styles, such as `bold cyan`, or an empty style."""


class Scoreboard:
    """Calls the plan's `module:function` for the headline; of the same module, `drawing` for a drawing beside it and
    `summary` for the closing lines, if they exist.

    The module names the channels that it needs in `CHANNELS`, as patterns.

    A scoreboard that fails is reported in the headline; the run goes on.
    """

    def __init__(self, name: str) -> None:
        self._module, _, self._function = name.partition(":")

    def headline(self, newest: Newest) -> str:
        """Returns one line for the top of the display; empty without a scoreboard."""
        if not self._module:
            return ""
        try:
            return str(getattr(import_module(self._module), self._function)(newest))
        except Exception as error:
            return f"scoreboard {self._module}:{self._function}: {type(error).__name__}: {error}"

    def drawing(self, newest: Newest, columns: int, rows: int) -> Drawing:
        """Returns a drawing of at most so many columns and rows; empty if the module draws nothing."""
        if not self._module:
            return []
        try:
            draw = getattr(import_module(self._module), "drawing", None)
            lines = draw(newest, columns, rows) if draw else []
            return [[(str(text), str(style)) for text, style in line] for line in lines][:rows]
        except Exception as error:
            return [[(f"drawing: {type(error).__name__}: {error}"[:columns], "yellow")]]

    def summary(self, newest: Newest) -> list[str]:
        """Returns closing lines; the headline if the module has no `summary`."""
        if not self._module:
            return []
        try:
            lines = getattr(import_module(self._module), "summary", None)
            return [str(line) for line in lines(newest)] if lines else [self.headline(newest)]
        except Exception as error:
            return [f"scoreboard {self._module}: {type(error).__name__}: {error}"]
