"""The plugin-control aspect: a component starts, stops and reloads other components."""

from collections.abc import Sequence

from fwk.model.selection import matches, nearest

REQUESTS_MAX = 64
"""Requests that a component may make in one iteration; more are refused as a mistake."""

PluginRequest = tuple[str, tuple[str, ...]]
"""Action, and names or patterns."""


class PluginControl:
    """Does what the commands `fwk start`, `stop`, `restart`, `reload`, `load` and `unload` do.

    Requests take effect at the next boundary and are recorded. A request that cannot be granted, such as unloading a
    camera that has users, is refused, and the log gives the reason. Names may be patterns: `cyan1/*`, `cyan1`.
    """

    def __init__(self, name: str, components: Sequence[str]) -> None:
        self.components = tuple(components)
        """All components of the plan, running or not."""
        self._name = name
        self._requests: list[PluginRequest] = []

    def start(self, *names: str) -> None:
        """Starts components whose needs are running."""
        self._ask("start", names)

    def stop(self, *names: str) -> None:
        """Stops components, also those that others use."""
        self._ask("stop", names)

    def restart(self, *names: str) -> None:
        """Stops components and starts them again."""
        self._ask("restart", names)

    def reload(self, *names: str) -> None:
        """Restarts components with the present code in their files."""
        self._ask("reload", names)

    def load(self, *names: str) -> None:
        """Starts components together with everything that they need."""
        self._ask("load", names)

    def unload(self, *names: str) -> None:
        """Stops components that no other component needs."""
        self._ask("unload", names)

    def _take(self) -> list[PluginRequest]:
        """Ends an iteration; returns its requests."""
        taken, self._requests = self._requests, []
        return taken

    def _ask(self, action: str, names: tuple[str, ...]) -> None:
        if not names:
            raise ValueError(f"{self._name}: {action}() needs names of components")
        for pattern in names if self.components else ():  # a test bench has no other components
            if not any(matches(name, pattern) for name in self.components):
                raise ValueError(f"{self._name}: no component '{pattern}'; {nearest(pattern, self.components)}")
        if len(self._requests) >= REQUESTS_MAX:
            limit = f"more than {REQUESTS_MAX} requests in one iteration"
            raise ValueError(f"{self._name}: {limit}; name several components in one request")
        self._requests.append((action, names))
