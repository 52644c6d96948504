"""Repeatedly takes the main loop over and gives it back, and restarts another component."""

from fwk import Clock, Component, MainLoop, PluginControl

ORDER = ["pre_loop", "sensor_acquire", "think", "sensor_prepare", "worldstate", "think", "act", "act", "post_loop"]


class Driver(Component):
    """Holds the main loop for eight of every twenty-four ticks."""

    stage = "think"
    clock: Clock
    main_loop: MainLoop
    plugins: PluginControl

    def loop(self) -> None:
        if self.clock.tick % 24 == 4:
            self.plugins.restart("d/player")
        if self.clock.tick % 24 == 8:
            self.main_loop.take_over(ORDER)
        if self.clock.tick % 24 == 16:
            self.main_loop.give_back()
