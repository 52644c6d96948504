"""Checks settings that depend on the channels of their component, such as the names of robots."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

from pydantic import ValidationError

from fwk.component.config import Config
from fwk.model.errors import Problems
from fwk.plan.files.settings import DEFAULT
from fwk.plan.resolve import Resolved
from fwk.plan.wiring.wiring import Wiring

Channels = Mapping[str, tuple[str, ...]]
"""Port attribute to channel names."""


def check_with_channels(components: Sequence[Resolved], wiring: Wiring, problems: Problems) -> None:
    """Checks the settings of each component again, with the channels of the system as `info.context` of validators."""
    names = [channel.name for channel in wiring.channels]
    for component, own in zip(components, wiring.ports, strict=True):
        for setting, text in mistakes_with_channels(component.declaration.config, component.config, own, names):
            problems.add(_place(component, setting), component.asked.name, text)


def mistakes_with_channels(
    config: type[Config], settings: Mapping[str, Any], own: Channels, names: Collection[str]
) -> Iterator[tuple[str, str]]:
    """Yields the settings that do not fit the channels, with what is wrong with each.

    Args:
        config: settings class of the component.
        settings: values to be checked.
        own: channels of the component.
        names: those of all components.
    """
    try:
        config.model_validate(settings, context={"channels": own, "all_channels": names})
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
