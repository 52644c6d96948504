"""A component without work."""

from fwk import Component


class Idle(Component):
    """Does nothing."""

    stage = "think"

    def loop(self) -> None: ...
