"""Settings of a component: typed fields with defaults, checked before anything starts."""

from functools import cache
from typing import Literal, Self

from pydantic import BaseModel, ConfigDict, Field, create_model

LOG_LEVEL = "log_level"
LogLevel = Literal["debug", "info", "warning", "error"]


class Alike:
    """Marks the type of a setting that is the same in all components of a system, which `fwk check` ensures.

    ```python
    Players = Annotated[dict[str, int], Alike]
    ```
    """


class Config(BaseModel):
    """Base class of settings: one field a line, with its unit and meaning as a docstring below.

    ```python
    class TrackerConfig(Config):
        gain: float = 0.3
        \"\"\"0 keeps the old position, 1 jumps to the newest sighting.\"\"\"
    ```
    A setting that cannot be changed during the run is frozen: `port: int = Field(7000, frozen=True)`.
    Unknown keys, wrong types and numbers that are not finite are refused. Nested settings are fields whose type is a
    `Config`. When a launch file or a change during a run is checked, validators get the channels of the component's
    ports once they are known: `info.context["channels"]["wheel_command"]`, and those of the whole system:
    `info.context["all_channels"]`; otherwise `info.context` is None.
    """

    model_config = ConfigDict(
        extra="forbid",
        validate_assignment=True,
        validate_default=True,
        allow_inf_nan=False,
    )

    def _take_over(self, other: Self) -> frozenset[str]:
        """Copies the checked values of `other` into this object and its nested objects.

        Returns the dotted names of the fields that changed.
        """
        changed: set[str] = set()
        for name in type(self).model_fields:
            old, new = getattr(self, name), getattr(other, name)
            if isinstance(old, Config) and type(new) is type(old):
                changed |= {f"{name}.{below}" for below in old._take_over(new)}
            elif old != new:
                self.__dict__[name] = new
                changed.add(name)
        return frozenset(changed)


@cache
def with_log_level(config: type[Config]) -> type[Config]:
    """Returns a component's settings class with the setting `log_level`, which every component has."""
    meaning = "lowest level of the lines that are logged; it affects nothing else"
    return create_model(
        config.__name__,
        __base__=config,
        __module__=config.__module__,
        __doc__=config.__doc__,
        log_level=(LogLevel, Field("info", description=meaning)),
    )
