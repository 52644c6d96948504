"""The plugin-control aspect: a component starts, stops and exchanges others."""

from collections.abc import Sequence

from fwk.model.selection import matches, nearest

WISHES_MAX = 64
"""That a component may have in an iteration; more is taken for a mistake."""

PluginWish = tuple[str, tuple[str, ...]]
"""Action, and names or patterns."""


class PluginControl:
    """Lets a component do what `fwk start`, `stop`, `restart`, `reload`, `load` and `unload` do.

    It happens between this tick and the next, and is recorded. What cannot be, such as unloading a camera that has
    users, is refused: the log says so, with who stands against it. Names may be patterns: `cyan1/*`, `cyan1`.
    """

    def __init__(self, name: str, components: Sequence[str]) -> None:
        self.components = tuple(components)
        """All of the run, those too that do not run now."""
        self._name = name
        self._wishes: list[PluginWish] = []

    def start(self, *names: str) -> None:
        """Starts components whose needs run."""
        self._ask("start", names)

    def stop(self, *names: str) -> None:
        """Stops components, whoever uses them."""
        self._ask("stop", names)

    def restart(self, *names: str) -> None:
        """Stops components and starts them again."""
        self._ask("restart", names)

    def reload(self, *names: str) -> None:
        """As `restart`, with the code as it is in the files now."""
        self._ask("reload", names)

    def load(self, *names: str) -> None:
        """Starts components with everything that they need."""
        self._ask("load", names)

    def unload(self, *names: str) -> None:
        """Stops components that nobody else needs."""
        self._ask("unload", names)

    def take(self) -> list[PluginWish]:
        """For the framework: what was asked in this iteration."""
        taken, self._wishes = self._wishes, []
        return taken

    def _ask(self, action: str, names: tuple[str, ...]) -> None:
        if not names:
            raise ValueError(f"{self._name}: {action} what? name components")
        for pattern in names if self.components else ():  # on a test bench there are no others
            if not any(matches(name, pattern) for name in self.components):
                raise ValueError(f"{self._name}: no component '{pattern}'; {nearest(pattern, self.components)}")
        if len(self._wishes) >= WISHES_MAX:
            raise ValueError(f"{self._name}: more than {WISHES_MAX} wishes in one iteration; name several in one")
        self._wishes.append((action, names))
