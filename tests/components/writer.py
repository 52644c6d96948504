"""A writer that opens its channel on command."""

from fwk import Blackboard, Component, Config
from fwk.component.blackboard import OpenWrites
from lcmtypes.robot import imu_t


class WriterConfig(Config):
    wants: bool = False


class Writer(Component):
    stage = "think"
    blackboard: Blackboard
    config: WriterConfig

    def init(self) -> None:
        self.brief: OpenWrites[imu_t] | None = None

    def loop(self) -> None:
        if self.config.wants and self.brief is None:
            self.brief = self.blackboard.open_for_writing(imu_t, "brief")
        if self.brief and self.brief.is_open:
            self.brief.write()
