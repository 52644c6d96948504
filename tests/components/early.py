"""Publishes a message in `init`; dies once."""

from pathlib import Path

from fwk import Clock, Component, Reads, Writes
from lcmtypes.soccer import pose_t


class Speaker(Component):
    stage = "think"
    reaches_outside = False
    clock: Clock
    pose: Writes[pose_t]

    def init(self) -> None:
        for self.pose.value.x_m in (1.0, 2.0):
            self.pose.write()
        self.pose.value.x_m = 3.0

    def loop(self) -> None:
        if self.clock.tick == 8 and not Path("died").exists():
            Path("died").touch()
            raise RuntimeError("enough")
        if self.clock.tick % 5 == 1:
            self.pose.write()


class Listener(Component):
    stage = "act"
    pose: Reads[pose_t]
    heard: Writes[pose_t]

    def init(self) -> None:
        self.heard.value.y_m = -1.0
        self.heard.write()

    def loop(self) -> None:
        for pose in self.pose.fresh:
            self.heard.value = pose
            self.heard.write()
