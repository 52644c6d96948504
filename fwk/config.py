"""Settings of a component: typed fields with defaults, checked before anything starts."""

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
