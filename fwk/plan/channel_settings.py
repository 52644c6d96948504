"""Checks settings that depend on the channels of their component, such as the names of robots."""

from collections.abc import Mapping, Sequence

from pydantic import ValidationError

from fwk.model.errors import Problems
from fwk.plan.files.settings import DEFAULT
from fwk.plan.resolve import Resolved

Channels = Mapping[str, tuple[str, ...]]
"""Port attribute to channel names."""


def check_with_channels(components: Sequence[Resolved], channels: Sequence[Channels], problems: Problems) -> None:
    """Checks the settings of each component again, with its channels as `info.context["channels"]` of validators."""
    for component, own in zip(components, channels, strict=True):
        try:
            component.declaration.config.model_validate(component.config, context={"channels": own})
        except ValidationError as error:
            for found in error.errors(include_url=False):
                setting = ".".join(map(str, found["loc"]))
                text = found["msg"].removeprefix("Value error, ")
                problems.add(_place(component, setting), component.asked.name, f"{setting}: {text}")


def _place(component: Resolved, setting: str) -> str:
    """Returns the place of the first value of a setting that the files have; without one, that of the component."""
    places = (
        place for name, place in component.origins.items() if f"{name}.".startswith(f"{setting}.") and place != DEFAULT
    )
    return next(places, component.asked.node.place)
