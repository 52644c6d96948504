"""What a view needs besides the newest messages: measures of the field, settings, and the age of messages."""

from collections.abc import Callable
from typing import Any, TypeVar

from pydantic import ValidationError

from procs.model.field import Field
from procs.model.units import US_PER_S

MEASURES = "world/field"
_NAMES = tuple(Field.model_fields)
_SILENT_S = 1.0  # what a component wrote so long before is not shown as present

M = TypeVar("M")


def settings_in(newest: Callable[[str], Any], name: str) -> dict[str, Any]:
    """Returns the simulator's settings of the field, the robot or the ball; empty if they are unknown."""
    return newest.settings("world/*", name) if hasattr(newest, "settings") else {}


def field_in(newest: Callable[[str], Any]) -> Field:
    """Returns the field of a match: as the simulator states it, or else by its settings, or the usual one.

    Impossible measures, such as those of a damaged message, do not count.
    """
    told = newest(MEASURES)
    measures = settings_in(newest, "field") if told is None else {name: getattr(told, name) for name in _NAMES}
    try:
        return Field(**measures)
    except ValidationError:
        return Field()


def recent(message: M, shown: Any) -> M | None:
    """Returns a message; None if its component was silent for a second before the message that is shown."""
    if message is None or shown.header.time_us - message.header.time_us > _SILENT_S * US_PER_S:  # type: ignore[attr-defined]
        return None
    return message
