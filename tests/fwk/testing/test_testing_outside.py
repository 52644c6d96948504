"""Messages from outside in a system in memory."""

from fwk import Component, Reads, Writes
from fwk.testing import MemorySystem
from lcmtypes.robot import imu_t, motor_command_t


class Obeys(Component):
    stage = "think"
    wish: Reads[motor_command_t]
    total: Writes[imu_t]

    def loop(self) -> None:
        self.total.value.heading_rad += sum(each.vx_m_s for each in self.wish.fresh)
        self.total.write()


def test_outside_messages_are_visible_from_the_next_tick_on() -> None:
    system = MemorySystem({"r/obeys": Obeys}, outside={"r/wish": motor_command_t})
    system.tick(2)
    for speed in (1.0, 2.0):
        wish = motor_command_t()
        wish.vx_m_s = speed
        system.come_in("r/wish", wish)
    assert system.newest("r/total").heading_rad == 0.0
    system.tick()
    assert system.newest("r/total").heading_rad == 3.0
    header = system.newest("r/wish").header
    assert (header.tick, header.stage, header.sequence, header.writer) == (3, -1, 2, "outside")
