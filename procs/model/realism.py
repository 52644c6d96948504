"""Names of the presets that say how far the simulation is from ideal."""

from typing import Any, Literal, TypeVar

from pydantic import BaseModel

Realism = Literal["none", "friendly", "realistic", "harsh"]
"""Body, ball, cameras, percepts and radio have values of their own for each preset."""

M = TypeVar("M", bound=BaseModel)


def chosen(preset: M, settings: Any) -> M:
    """Returns the preset with the values that `settings` has under the same names, where they are not None."""
    own = {name: getattr(settings, name, None) for name in type(preset).model_fields}
    return preset.model_copy(update={name: value for name, value in own.items() if value is not None})
