"""A component for wiring: the declaration of its class, and where the launch file differs from it."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from fwk.component.declaration import Declaration
from fwk.component.port import Port

Report = Callable[[str, str | None, str], None]
"""Takes a mistake: component, attribute of a port or None, text."""


@dataclass(frozen=True)
class ComponentSpec:
    """A component as the launch file specifies it."""

    name: str
    declaration: Declaration
    channels: Mapping[str, str] = field(default_factory=dict)
    """Attribute of a port to channel or pattern, where the launch file differs from the class."""
    providers: Mapping[str, str] = field(default_factory=dict)
    """Attribute of an aspect to its provider, where the launch file names one."""

    @property
    def namespace(self) -> str:
        """Part of the name before the last slash."""
        return self.name.rpartition("/")[0]

    def pattern(self, port: Port) -> str:
        """Returns the full channel name or pattern of a port; one that begins with a slash has no namespace."""
        name = self.channels.get(port.attribute, port.channel)
        if name.startswith("/"):
            return name[1:]
        return name if "/" in name or not self.namespace else f"{self.namespace}/{name}"
