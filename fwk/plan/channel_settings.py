"""Checks settings that depend on the channels of their component, such as the names of robots."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from fwk.component.config import Config
from fwk.model.errors import Problems
from fwk.plan.files.settings import DEFAULT
from fwk.plan.resolve import Resolved

Channels = Mapping[str, tuple[str, ...]]
"""Port attribute to channel names."""


def check_with_channels(components: Sequence[Resolved], channels: Sequence[Channels], problems: Problems) -> None:
    """Checks the settings of each component again, with its channels as `info.context["channels"]` of validators."""
    for component, own in zip(components, channels, strict=True):
        for setting, text in mistakes_with_channels(component.declaration.config, component.config, own):
            problems.add(_place(component, setting), component.asked.name, text)


def mistakes_with_channels(
    config: type[Config], settings: Mapping[str, Any], channels: Channels
) -> Iterator[tuple[str, str]]:
    """Yields the settings that do not fit the channels of their component, with what is wrong with each."""
    try:
        config.model_validate(settings, context={"channels": channels})
    except ValidationError as error:
        for found in error.errors(include_url=False):
            setting = ".".join(map(str, found["loc"]))
            yield setting, f"{setting}: {found['msg'].removeprefix('Value error, ')}"
    except Exception as error:  # of a validator of the component's own
        yield "", f"its settings cannot be checked: {type(error).__name__}: {error}"


def _place(component: Resolved, setting: str) -> str:
    """Returns the place of the first value of a setting that the files have; without one, that of the component."""
    places = (
        place for name, place in component.origins.items() if f"{name}.".startswith(f"{setting}.") and place != DEFAULT
    )
    return next(places, component.asked.node.place)
