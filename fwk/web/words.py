"""Texts of pages: figures as people read them, and words that people type."""

import shlex
from typing import Any

from fwk.clock import US_PER_S


def seconds(time_us: int) -> str:
    """Returns logical time as minutes and seconds."""
    minutes, rest_us = divmod(time_us, 60 * US_PER_S)
    return f"{minutes}:{rest_us / US_PER_S:05.2f}"


def age(age_s: float | None) -> str:
    """Returns the time since an event, short."""
    if age_s is None:
        return "never"
    if age_s < 10:
        return f"{age_s:.2f} s"
    return f"{age_s:.0f} s" if age_s < 600 else f"{age_s / 60:.0f} min"


def size(count_bytes: int) -> str:
    """Returns a number of bytes in a suitable unit."""
    for unit, factor in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if count_bytes >= factor:
            return f"{count_bytes / factor:.1f} {unit}"
    return f"{count_bytes} B"


def rows_of(name: str, value: Any) -> list[tuple[str, str]]:
    """Returns a message as rows of dotted field and value; long arrays are shortened."""
    if isinstance(value, dict):
        return [row for key, below in value.items() for row in rows_of(f"{name}.{key}" if name else key, below)]
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return [row for number, item in enumerate(value[:20]) for row in rows_of(f"{name}[{number}]", item)]
    return [(name, _word(value))]


def _word(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, list):
        shown = ", ".join(_word(item) for item in value[:16])
        return f"[{shown}{f', ... ({len(value)})' if len(value) > 16 else ''}]"
    return str(value)


def options_of(typed: str) -> list[str]:
    """Returns the options of a command for settings that were typed in one line; quotes keep a value with spaces.

    Raises:
        ValueError: a quote is not closed.
    """
    return [word for each in shlex.split(typed) for word in ("--set", each)]
