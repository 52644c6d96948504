"""A component as wiring sees it: its class's declaration and what the launch file says otherwise."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from fwk.component.declaration import Declaration
from fwk.component.port import Port

Report = Callable[[str, str | None, str], None]
"""Takes a mistake: component, port attribute or None, text."""


@dataclass(frozen=True)
class Wish:
    """A component as the launch file asks for it."""

    name: str
    declaration: Declaration
    channels: Mapping[str, str] = field(default_factory=dict)
    """Port attribute to channel or pattern, where the launch file says other than the class."""
    providers: Mapping[str, str] = field(default_factory=dict)
    """Attribute of an aspect to the component that provides it, where the launch file says so."""

    @property
    def namespace(self) -> str:
        """Everything before the last slash of the name."""
        return self.name.rpartition("/")[0]

    def pattern(self, port: Port) -> str:
        """The full channel name or pattern of a port; one that begins with a slash has no namespace."""
        name = self.channels.get(port.attribute, port.channel)
        if name.startswith("/"):
            return name[1:]
        return name if "/" in name or not self.namespace else f"{self.namespace}/{name}"
