"""Settings of a component: typed fields with defaults, checked before anything starts."""

from functools import cache
from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, create_model

LOG_LEVEL = "log_level"
LogLevel = Literal["debug", "info", "warning", "error"]


class Config(BaseModel):
    """Base of every component's settings: one field a line, its unit and meaning as a docstring below it.

    ```python
    class TrackerConfig(Config):
        gain: float = 0.3
        \"\"\"0 keeps the old position, 1 jumps to the newest sighting.\"\"\"
    ```
    A setting that cannot be changed while the run goes on says so: `port: int = Field(7000, frozen=True)`.
    Unknown keys, wrong types and numbers that are not finite are refused. Nested settings are fields that are
    `Config`s themselves.
    """

    model_config = ConfigDict(
        extra="forbid",
        use_attribute_docstrings=True,
        validate_assignment=True,
        validate_default=True,
        allow_inf_nan=False,
    )

    def take_over(self, other: Self) -> frozenset[str]:
        """Becomes like `other`, whose values are checked already; whoever holds this object, or one nested in it, sees
        the new values. Returns the dotted names of those that changed.
        """
        changed: set[str] = set()
        for name in type(self).model_fields:
            old, new = getattr(self, name), getattr(other, name)
            if isinstance(old, Config) and type(new) is type(old):
                changed |= {f"{name}.{below}" for below in old.take_over(new)}
            elif old != new:
                self.__dict__[name] = new
                changed.add(name)
        return frozenset(changed)


@cache
def with_log_level(config: type[Config]) -> type[Config]:
    """A component's settings as its class has them, and the level of its log lines, which every component has."""
    meaning = "lines of this level and worse are logged; it decides nothing else"
    return create_model(
        config.__name__,
        __base__=config,
        __module__=config.__module__,
        __doc__=config.__doc__,
        log_level=(LogLevel, Field("info", description=meaning)),
    )
