"""A component that starts and stops others by a script, and its rival."""

from fwk import Clock, Component, PluginControl


class Director(Component):
    """Carries out a script of requests."""

    stage = "worldstate"
    clock: Clock
    plugins: PluginControl

    def loop(self) -> None:
        tick, plugins = self.clock.tick, self.plugins
        if tick == 5:
            plugins.stop("r/counter")
        elif tick == 8:
            plugins.load("r/finder")
        elif tick == 10:
            plugins.start("r/counter")
            plugins.unload("r/camera")
        elif tick == 11:
            plugins.stop("r/follower")
            plugins.start("r/follower")
        elif tick == 12:
            plugins.restart("r")


class Rival(Director):
    """Makes a different request in the same tick; its name sorts after the director's."""

    def loop(self) -> None:
        if self.clock.tick == 5:
            self.plugins.start("r/counter")
        elif self.clock.tick == 7:
            self.plugins.stop("r/counter")
