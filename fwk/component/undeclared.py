"""Explains the use of an attribute that a component does not have."""

from collections.abc import Mapping
from difflib import get_close_matches
from typing import Any

ANNOTATIONS = {
    "blackboard": "Blackboard",
    "clock": "Clock",
    "image": "Image",
    "lines": "LogLines",
    "log": "Logger",
    "logger": "Logger",
    "main_loop": "MainLoop",
    "plugins": "PluginControl",
    "tf": "Transforms",
    "time_source": "TimeSource",
    "transforms": "Transforms",
}
"""Attribute, as components usually call it, to the class of `fwk` that its annotation names."""


def explanation(kind: type, attributes: Mapping[str, Any], missing: str) -> str:
    """Returns the text of an AttributeError: the class and the attributes of a component, and the one that it lacks."""
    text = f"'{kind.__name__}' object has no attribute '{missing}'"
    if missing.startswith("_"):
        return text
    declared = {name for base in kind.__mro__ for name in vars(base).get("__annotations__", ())}
    if missing in declared:
        return f"{text} yet; the framework sets it before init, so use it from init on, not in __init__"
    if missing == "config":
        return f"{text}; declare the class of the settings, derived from fwk.Config: config: {kind.__name__}Config"
    if missing == "rng":
        return f"{text}; declare it in the class: rng: np.random.Generator (import numpy as np)"
    if missing in ANNOTATIONS:
        aspect = ANNOTATIONS[missing]
        return f"{text}; declare it in the class: {missing}: {aspect} (from fwk import {aspect})"
    if missing in getattr(type(attributes.get("config")), "model_fields", ()):
        return f"{text}; it is a setting: config.{missing}"
    near = get_close_matches(missing, sorted({*declared, *attributes}), 1)
    return f"{text}; did you mean '{near[0]}'?" if near else text
