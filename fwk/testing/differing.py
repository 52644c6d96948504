"""Difference of two campaigns, in the words of the command line."""

import json
from collections.abc import Mapping
from typing import Any

_TYPED = {"time_s": "--time", "sets": "--set", "file": "the launch file", "by": "the evaluation"}
"""What a user typed, or finds in the launch file, by the keys of a campaign's note."""
_DIGESTS = ("plan", "run")
"""Keys of digests, which say nothing: of components and their settings, and of the run's own settings."""


def differing(old: Mapping[str, Any], new: Mapping[str, Any]) -> str:
    """Returns how another campaign differs from this one: `--time is 60 there, 30 here`; empty if it does not.

    Settings that lead to the same plan and the same run are no difference, however they were typed.
    """
    keys = [key for key in {**old, **new} if key != "run" and old.get(key) != new.get(key)]
    if not keys or (keys == ["sets"] and _mean_the_same(old, new)):
        return ""
    shown = [key for key in keys if key not in _DIGESTS]
    if not shown:
        return "its launch file had other components or settings"
    return ", ".join(
        f"{_TYPED.get(key, key)} is {_said(old.get(key))} there, {_said(new.get(key))} here" for key in shown
    )


def _mean_the_same(old: Mapping[str, Any], new: Mapping[str, Any]) -> bool:
    """Returns whether settings lead to the same run; a note of former code says so only if they were typed alike."""
    if None not in (old.get("plan"), old.get("run")):
        return bool(old["run"] == new.get("run"))
    return _sorted(old.get("sets")) == _sorted(new.get("sets"))


def _sorted(values: Any) -> list[str]:
    """Returns the values of a list in an order of their own; of anything else itself."""
    return sorted(map(str, values)) if isinstance(values, list) else [str(values)]


def _said(value: Any) -> str:
    """Returns a value as it was typed."""
    if isinstance(value, list):
        return " ".join(map(str, value)) or "none"
    if isinstance(value, float):
        return str(value).removesuffix(".0")
    return "none" if value is None else value if isinstance(value, str) else json.dumps(value)
