"""A component that walks: the steps that programs add up."""

from fwk import Component, Writes
from lcmtypes.walk import step_t


class Walker(Component):
    """Writes the number of the tick."""

    stage = "sensor_acquire"
    step: Writes[step_t]

    def loop(self) -> None:
        self.step.value.x += 1.0
        self.step.write()
