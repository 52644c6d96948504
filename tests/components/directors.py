"""A component that starts and stops others by a script, and its rival."""

from fwk import Clock, Component, PluginControl


class Director(Component):
    """Has a script."""

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
    """Asks for something else in the same tick; its name comes later."""

    def loop(self) -> None:
        if self.clock.tick == 5:
            self.plugins.start("r/counter")
        elif self.clock.tick == 7:
            self.plugins.stop("r/counter")
