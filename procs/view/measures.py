"""Measures of the field, settings and the age of messages, for all views of a match."""

from collections.abc import Callable
from typing import Any

from pydantic import ValidationError

from procs.model.field import Field
from procs.model.units import US_PER_S

MEASURES = "world/field"
_SILENT_S = 1.0  # what a component wrote so long before is not shown as present


def settings_in(newest: Callable[[str], Any], name: str) -> dict[str, Any]:
    """Returns the simulator's settings of the field, the robot or the ball; empty if they are unknown."""
    return newest.settings("world/*", name) if hasattr(newest, "settings") else {}


def field_in(newest: Callable[[str], Any]) -> Field:
    """Returns the field of a match: as the simulator states it, or else by its settings, or the usual one.

    Impossible measures, such as those of a damaged message, do not count.
    """
    told = newest(MEASURES)
    try:
        if told is None:
            return Field(**settings_in(newest, "field"))
        return Field.model_validate(told, from_attributes=True)
    except ValidationError:
        return Field()


def recent(message: Any, shown: Any) -> Any:
    """Returns a message; None if its component was silent for a second before the message that is shown."""
    if message is None or shown.header.time_us - message.header.time_us > _SILENT_S * US_PER_S:
        return None
    return message
