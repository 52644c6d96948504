"""A speaker that restarts repeatedly and writes until its end, and a listener."""

import zlib

import weather  # noqa: F401 - loses datagrams if its settings ask for it
from fwk import Clock, Component, PluginControl, Reads, Writes
from lcmtypes.robot import imu_t


class Talker(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1.0
        self.imu.write()

    def finalize(self) -> None:
        self.imu.value.heading_rad = -1.0
        self.imu.write()


class Listener(Component):
    stage = "think"
    clock: Clock
    plugins: PluginControl
    imu: Reads[imu_t]
    heard: Writes[imu_t]

    def loop(self) -> None:
        for message in self.imu.fresh:
            self.heard.value.heading_rad = float(zlib.crc32(message.encode() + b"%r" % self.heard.value.heading_rad))
        self.heard.write()
        if self.clock.tick % 2:
            self.plugins.restart("r/talker")
