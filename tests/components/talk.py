"""A talker whose messages get lost before it dies, and its listener."""

import os
import signal
from pathlib import Path
from typing import Any

from fwk import Clock, Component, Reads, Writes
from fwk.host.outputs import Outputs
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


def lose_and_die() -> None:
    publish = Outputs.publish

    def publish_nothing(self: Outputs, written: Any) -> Any:
        sender: Any = self._sender
        send = sender.publish

        def send_last(*done: Any) -> None:
            send(*done)
            os.kill(os.getpid(), signal.SIGKILL)

        sender.publish = lambda *_: None
        marks = publish(self, written)
        sender.publish = send_last
        return marks

    Outputs.publish = publish_nothing  # type: ignore[method-assign]


class Talker(Component):
    """Writes many messages, once."""

    stage = "sensor_acquire"
    reaches_outside = False
    clock: Clock
    imu: Writes[imu_t]

    def loop(self) -> None:
        much = self.clock.tick == 5
        for _ in range(20_000 if much else 1):
            self.imu.value.heading_rad += 1.0
            self.imu.write()
        if much and not Path("died").exists():
            Path("died").touch()
            lose_and_die()


class Listener(Component):
    """Counts the messages it hears."""

    stage = "think"
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.x_m = float(len(self.imu.fresh))
        self.pose.value.y_m += sum(each.heading_rad for each in self.imu.fresh)
        self.pose.write()
