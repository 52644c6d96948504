"""A mower that drives on a circle, says what a browser must not take for markup, and obeys."""

import math

import numpy as np
from pydantic import Field

from fwk import Clock, Component, Config, Logger, Reads, Serves, VisionMaster, Writes, channel
from lcmtypes.garden import place_t, visit_t, wish_t
from lcmtypes.robot import joystick_t, laser_scan_t

HOSTILE = "<img src=x onerror=\"document.title='broken in'\"><script>document.title='broken in'</script>"


class MowerConfig(Config):
    radius_m: float = Field(2.0, gt=0.0, le=5.0, description=f"Radius of the circle {HOSTILE}")
    loud: bool = Field(False, description="Whether it says every place.")
    motto: str = HOSTILE


class Mower(Component):
    """Drives on a circle until it is sent elsewhere."""

    stage = "act"
    clock: Clock
    log: Logger
    config: MowerConfig
    place: Writes[place_t]
    visit: Serves[visit_t]
    wish: Reads[wish_t] = channel("garden/wish")

    def init(self) -> None:
        self.middle_m = (0.0, 0.0)

    def loop(self) -> None:
        if self.clock.tick % 10 == 1:
            self.log.warning(f"grass {HOSTILE}")
        while command := self.visit.take():
            if math.hypot(command.value.x_m, command.value.y_m) > 10.0:
                command.reject(f"that is beyond the fence {HOSTILE}")
                continue
            self.middle_m = (command.value.x_m, command.value.y_m)
            self.log.info(f"visits {self.middle_m}, {command.value.note}, {list(command.value.stops_m)}")
            command.done()
        if self.wish.refreshed:
            self.log.info(f"wish {self.wish.value.number}: {self.wish.value.text}")
        angle_rad = 0.1 * self.clock.tick
        place = self.place.value
        place.x_m = self.middle_m[0] + self.config.radius_m * math.cos(angle_rad)
        place.y_m = self.middle_m[1] + self.config.radius_m * math.sin(angle_rad)
        place.heading_rad = angle_rad + math.pi / 2
        place.covariance_m2 = [[0.04, 0.01], [0.01, 0.02]]
        place.label = HOSTILE
        self.place.write()


class Watcher(Component):
    """Sees the mower."""

    stage = "post_loop"
    place: Reads[place_t] = channel("a/place")

    def loop(self) -> None: ...


class Eye(Component):
    """A camera that sees a grey ramp."""

    stage = "sensor_acquire"
    image: VisionMaster

    def loop(self) -> None:
        self.image.publish(np.tile(np.arange(64, dtype=np.uint8), (48, 1)))


class Probe(Component):
    """A laser that sees a round wall, and says how a joystick is pushed."""

    stage = "sensor_acquire"
    log: Logger
    scan: Writes[laser_scan_t]
    stick: Reads[joystick_t] = channel("garden/stick")

    def init(self) -> None:
        self.axes: list[float] = []

    def loop(self) -> None:
        scan = self.scan.value
        scan.n_ranges, scan.ranges_m = 90, [3.0] * 90
        scan.angle_step_rad, scan.range_max_m = math.tau / 90, 10.0
        self.scan.write()
        if self.stick.refreshed and list(self.stick.value.axes) != self.axes:
            self.axes = list(self.stick.value.axes)
            self.log.info(f"stick {self.axes}")
