"""A sensor, a world model and a thinker."""

from pathlib import Path

from fwk import Component, Reads, Writes
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class Sensor(Component):
    """Writes a heading that changes in each tick."""

    stage = "sensor_acquire"
    reaches_outside = False
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 0.1
        self.imu.write()
        Path("turns.new").write_text(str(self.imu.value.header.tick))
        Path("turns.new").rename("turns.txt")  # a reader never sees half a message


class WorldModel(Component):
    """Copies the sensor's newest value."""

    stage = "worldstate"
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.heading_rad = self.imu.value.heading_rad
        self.pose.write()
