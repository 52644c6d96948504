"""A driver of a device, and a listener to the device."""

import os
from pathlib import Path

from fwk import Clock, Component, Config, Each, Reads, Writes, channel
from lcmtypes.devices import joy_t, motor_t
from lcmtypes.robot import imu_t


class DriverConfig(Config):
    gain: float = 1.0
    """Power of the motors a unit of the stick."""


class Driver(Component):
    """Moves the motors as the stick commands; without a stick they follow the clock."""

    stage = "think"
    reaches_outside = False
    config: DriverConfig
    clock: Clock
    joy: Reads[joy_t] = channel("/JOYSTICK", history=3)
    motor: Writes[motor_t] = channel("/MOTORS")
    parts: Each[Writes[motor_t]]
    seen: Writes[imu_t]

    def init(self) -> None:
        Path("driver.pid").write_text(str(os.getpid()))

    def loop(self) -> None:
        joy, motor = self.joy.value, self.motor.value
        stick = joy.axes[1] if joy.n_axes else 0.01 * self.clock.tick
        motor.utime, motor.power = joy.utime, [self.config.gain * stick, -stick]
        self.motor.write()
        for part in self.parts.values():
            part.value.power = motor.power
            part.write()
            part.write()
        self.seen.value.heading_rad += sum(each.utime for each in self.joy.fresh)
        self.seen.value.yaw_rate_rad_s = self.joy.header.sequence + 0.001 * self.joy.header.tick
        self.seen.write()


class Listener(Component):
    """Sums up the commands to the parts."""

    stage = "act"
    parts: Each[Reads[motor_t]]
    one: Reads[motor_t] = channel("left/parts")
    other: Reads[motor_t] = channel("right/parts")
    heard: Writes[imu_t]

    def loop(self) -> None:
        for part in self.parts.values():
            self.heard.value.heading_rad += sum(each.power[1] for each in part.fresh)
            self.heard.value.yaw_rate_rad_s += part.changed + 10 * part.refreshed
        self.heard.write()
