"""A counter whose increment comes from a plain module."""

import helper
from fwk import Component, Writes
from lcmtypes.robot import imu_t


class Counter(Component):
    """Counts up."""

    stage = "think"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += helper.ADDED
        self.imu.write()
