"""Settings of a component: typed fields with defaults, checked before anything starts."""

from typing import Self

from pydantic import BaseModel, ConfigDict


class Config(BaseModel):
    """Base of every component's settings: one field a line, its unit and meaning as a docstring below it.

    ```python
    class TrackerConfig(Config):
        gain: float = 0.3
        \"\"\"0 keeps the old position, 1 jumps to the newest sighting.\"\"\"
    ```
    Unknown keys and wrong types are refused. Nested settings are fields that are `Config`s themselves.
    """

    model_config = ConfigDict(
        extra="forbid", use_attribute_docstrings=True, validate_assignment=True, validate_default=True
    )

    def take_over(self, other: Self) -> None:
        """Becomes like `other`, whose values are checked already; whoever holds this object, or one nested in it, sees
        the new values.
        """
        for name in type(self).model_fields:
            old, new = getattr(self, name), getattr(other, name)
            if isinstance(old, Config) and type(new) is type(old):
                old.take_over(new)
            else:
                self.__dict__[name] = new
