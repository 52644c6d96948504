"""Driver of a device that acts."""

from typing import Any

from fwk import Clock, Component, Config, Field, Logger, Reads, Writes
from lcmtypes.thing import thing_command_t, thing_t


class ThingConfig(Config):
    """Settings of the driver."""

    device: str = Field("", frozen=True)
    """Path of the device; empty: none, the driver only reports what the device would do."""
    command_timeout_s: float = Field(0.5, gt=0.0)
    """The device stops when its newest command is older."""


class Thing(Component):
    """Passes commands to its device and stops it when commands are missing."""

    stage = "act_exec"

    config: ThingConfig
    clock: Clock
    log: Logger
    thing_command: Reads[thing_command_t]
    thing: Writes[thing_t]

    @classmethod
    def unrepeatable(cls, config: Any) -> str:
        return f"'{config.device}' is a device" if config.device else ""

    def init(self) -> None:
        self.device = open(self.config.device, "wb", buffering=0) if self.config.device else None  # noqa: SIM115
        self.late = False

    def loop(self) -> None:
        age_s = self.clock.since_s(self.thing_command.header.time_us)
        late = self.thing_command.has_value and age_s > self.config.command_timeout_s
        if late and not self.late:
            self.log.warning(f"no command for {age_s:.2f} s: stopping")
        self.late = late
        wanted = 0.0 if late else self.thing_command.value.power
        self.act(min(1.0, max(-1.0, wanted)))

    def finalize(self) -> None:
        self.act(0.0)
        if self.device:
            self.device.close()

    def act(self, power: float) -> None:
        """Sends the power, from -1 to 1, to the device and reports it."""
        if self.device:
            self.device.write(f"{power:.3f}\n".encode())
        self.thing.value.power = power
        self.thing.write()
