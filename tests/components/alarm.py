"""A component that raises alarms, and one that listens to them."""

from fwk import Clock, Component, Config, Logger, LogLines, Writes
from lcmtypes.robot import imu_t


class WorrierConfig(Config):
    lines: int = 1
    """Warnings in tick 5."""
    raises: bool = False
    """Whether the component dies in that tick."""


class Worrier(Component):
    stage = "think"
    clock: Clock
    config: WorrierConfig
    log: Logger

    def loop(self) -> None:
        self.log.debug("not from where it stands")
        if self.clock.tick == 5:
            for number in range(self.config.lines):
                self.log.warning(f"worry {number}")
            print("printed")
            if self.config.raises:
                raise RuntimeError("enough")


class Listener(Component):
    stage = "post_loop"
    lines: LogLines
    log: Logger
    heard: Writes[imu_t]

    def loop(self) -> None:
        for line in self.lines.of("warning"):
            self.heard.value.heading_rad += line.wall_us % 1000 / 1000 + len(line.text)
            self.log.warning(f"heard of {line.component}: {line.text}")
        self.heard.write()


class Free(Listener):
    stage = ()  # type: ignore[assignment]
    rate_hz = 0
