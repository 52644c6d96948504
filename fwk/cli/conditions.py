"""Reads conditions of the command line: ranges, moments, patterns."""

import math
import re
import sys
import warnings
from datetime import UTC, datetime, timedelta

import typer

from fwk.clock import US_PER_S, wall_us


def ticks(text: str) -> tuple[int, int]:
    """Returns first and last tick of `120`, `100..200`, `100-200`, `100..`, `..200`.

    Raises:
        BadParameter: the text is none of these.
    """
    found = re.fullmatch(r"(\d{0,18})(\.\.|-)?(\d{0,18})", text, re.ASCII)
    if not found or not (found[1] or found[3]):
        raise typer.BadParameter(f"--tick: '{text}' is not a tick; use 120, or 100..200")
    first = int(found[1] or 0)
    return _ordered(first, int(found[3] or sys.maxsize) if found[2] else first, f"--tick: '{text}'")


def times_us(text: str) -> tuple[int, int]:
    """Returns first and last logical time, in microseconds, of `1.5..2`, `1.5..`, `..2`, which are seconds.

    Raises:
        BadParameter: the text is none of these.
    """
    first, dots, last = text.partition("..")
    try:
        if dots and (first or last):
            first_us, last_us = round(float(first or 0) * US_PER_S), round(float(last or 0) * US_PER_S)
            return _ordered(first_us, last_us if last else sys.maxsize, f"--time: '{text}'")
    except (ValueError, OverflowError):
        pass
    raise typer.BadParameter(f"--time: '{text}' is not a range of seconds; use 1.5..2, or 1.5..")


def _ordered(first: int, last: int, said: str) -> tuple[int, int]:
    if first > last:
        raise typer.BadParameter(f"{said} begins after its end; give the smaller number first")
    return first, last


def moment_us(text: str, option: str) -> int:
    """Returns the wall time of `90`, seconds ago, or of `14:05` or `14:05:30`, the last such moment, in microseconds.

    Raises:
        BadParameter: the text is none of these.
    """
    now_us = wall_us()
    if re.fullmatch(r"\d\d?:\d\d(:\d\d)?", text, re.ASCII):
        parts = [int(part) for part in text.split(":")]
        if parts[0] < 24 and max(parts[1:]) < 60:
            now = datetime.fromtimestamp(now_us / US_PER_S, UTC).astimezone()
            then = now.replace(hour=parts[0], minute=parts[1], second=(parts[2:] or [0])[0], microsecond=0)
            return round((then if then <= now else then - timedelta(days=1)).timestamp() * US_PER_S)
    else:
        try:
            seconds = float(text)
            if 0 <= seconds < math.inf:
                return now_us - round(seconds * US_PER_S)
        except ValueError:
            pass
    raise typer.BadParameter(f"{option}: '{text}' is not a time; give seconds ago, or a time of day such as 14:05")


def pattern(text: str, option: str) -> re.Pattern[str]:
    """Compiles a regular expression that ignores case.

    Raises:
        BadParameter: the text is not a regular expression.
    """
    try:
        with warnings.catch_warnings(action="ignore", category=FutureWarning):  # of syntax that may change its meaning
            return re.compile(text, re.IGNORECASE)
    except (re.error, OverflowError, RecursionError) as error:
        right = re.escape(text)
        raise typer.BadParameter(
            f"{option}: '{text}' is not a regular expression: {error}; as plain text: {right}"
        ) from error
