import numpy as np

from fwk import Calls, Component, Logger, Reads, VisionMaster, Writes, channel
from lcmtypes.lift import lift_t
from lcmtypes.robot import imu_t


class Flooder(Component):
    stage = "think"
    log: Logger
    image: VisionMaster
    imu: Writes[imu_t]
    lift: Calls[lift_t] = channel("r/lift")

    def loop(self) -> None:
        self.image.publish(np.zeros((4, 4), np.uint8))
        for number in range(300):
            self.log.info("much too much " + str(number))
            self.imu.value.heading_rad += 1.0
            self.imu.write()
            self.lift.call()


class Listener(Component):
    stage = "act"
    imu: Reads[imu_t] = channel("x/imu")
    heard: Writes[imu_t]

    def loop(self) -> None:
        self.heard.value.heading_rad += len(self.imu.fresh)
        self.heard.write()
