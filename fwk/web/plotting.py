"""Curves of numeric fields over logical time."""

import re
from collections import deque
from collections.abc import Sequence
from typing import Any

from fwk.clock import US_PER_S
from fwk.log_tools.series import Series

POINTS_MAX = 1200
_FIELD = re.compile(r"\s*([^\s.]+)\.([\w.\[\]]+)\s*", re.ASCII)
_STEP = re.compile(r"\.?(\w+)|\[(\d+)\]", re.ASCII)


class FieldNameError(ValueError):
    """A text that is not CHANNEL.FIELD."""


def parted(text: str) -> tuple[str, str]:
    """Returns channel and field of a text such as `cyan1/pose.x_m` or `cyan1/model.mates[0].x_m`.

    Raises:
        FieldNameError: it is not such a text.
    """
    found = _FIELD.fullmatch(text)
    if not found:
        raise FieldNameError(f"'{text}' is not CHANNEL.FIELD, such as cyan1/pose.x_m")
    return found[1], found[2]


def number_at(message: Any, field: str) -> float | None:
    """Returns the number in a field of a message; None if there is none."""
    value = message
    for name, index in _STEP.findall(field):
        if name:
            value = getattr(value, name, None)
        else:
            value = value[int(index)] if isinstance(value, list | tuple) and int(index) < len(value) else None
    return float(value) if isinstance(value, int | float) else None


class Curves:
    """The newest points of some fields; a field that is added later begins later."""

    def __init__(self) -> None:
        self._points: dict[str, deque[tuple[float, float]]] = {}

    def choose(self, fields: list[str]) -> None:
        """Keeps the points of these fields alone."""
        self._points = {each: self._points.get(each, deque(maxlen=POINTS_MAX)) for each in fields}

    def add(self, field: str, time_us: int, value: float | None) -> None:
        """Adds a point, unless it is the last one; one that lies before the last one begins the curve anew."""
        points = self._points.get(field)
        time_s = time_us / US_PER_S
        if points is None or value is None or (points and points[-1][0] == time_s):
            return
        if points and time_s < points[-1][0]:
            points.clear()
        points.append((time_s, value))

    def series(self) -> list[dict[str, Any]]:
        """Returns the curves for the chart."""
        return [
            {"type": "line", "name": name, "showSymbol": False, "data": [list(point) for point in points]}
            for name, points in self._points.items()
        ]


def recorded_series(found: Sequence[Series]) -> list[dict[str, Any]]:
    """Returns series of a log as curves for the chart, thinned to as many points as a live curve has."""
    return [
        {"type": "line", "name": each.label, "showSymbol": False, "data": _thinned(each)}
        for each in found
        if each.values
    ]


def _thinned(series: Series) -> list[list[float]]:
    step = -(-len(series.values) // POINTS_MAX)
    return [[time_s, value] for time_s, value in zip(series.times_s[::step], series.values[::step], strict=True)]
