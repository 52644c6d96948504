"""Reports of a host about its components: once a second, and if possible while it is awake anyway."""

from fwk.bus import sync
from fwk.bus.memory_network import MemoryNetwork
from fwk.bus.sockets import GROUP, Address
from fwk.component.component import DEFAULT_STAGES
from fwk.engine.assignment import Assignment, Start
from fwk.host.continuous import host_of
from fwk.host.hooks import ProcessHooks
from fwk.host.host import READY_REPORT_US, REPORT_US, TICK_AWAITED_US
from fwk.lcm import wire
from fwk.model.ports import Ports
from lcmtypes.core import actual_t, protocol_t, tick_t
from tests.fwk.host.host_parts import plan

WRITER = 0
STAGE = DEFAULT_STAGES.index("sensor_acquire")
RUN = 7


class Driven:
    """A host whose ticks and wall time the test decides."""

    def __init__(self) -> None:
        made = plan(7700)
        self.sent: list[bytes] = []
        """Channels of the dones and reports, in the order in which the host sent them."""
        self.reports: list[actual_t] = []
        self.ports = Ports.of(made)
        self.network = MemoryNetwork(self._take)
        self._assembler = wire.Assembler()
        assignment = Assignment(made, WRITER, RUN, Start(1, {}, {}), {})
        self.steps = host_of(assignment, self.network, ProcessHooks(stopping=lambda: False)).serve()
        self.until_us = next(self.steps)
        """Wall time at which the host wakes without a message."""

    def tick(self, number: int, at_us: int) -> None:
        """Sends a tick at a wall time before which the host does not wake."""
        assert at_us < self.until_us
        self.network.clock_us = at_us
        tick = tick_t()
        tick.version, tick.run, tick.tick, tick.step = protocol_t.VERSION, RUN, number, STAGE
        datagram = wire.in_one(number, sync.TICK, sync.encode_tick(tick))
        self.network.put(datagram, (GROUP, self.ports.stage(STAGE)), self.ports.supervisor)
        self.until_us = self.network.run(self.steps, self.until_us)

    def wake(self) -> None:
        """Lets time pass until the host wakes."""
        self.until_us = self.network.run_once(self.steps, self.until_us)

    def _take(self, datagram: bytes, address: Address) -> None:
        message = self._assembler.feed(datagram, address[1])
        if message and message[0] in (sync.DONE, sync.ACTUAL):
            self.sent.append(message[0])
        if message and message[0] == sync.ACTUAL:
            self.reports.append(sync.decode_actual(message[1]))


def test_ready_host_reports_until_its_first_tick() -> None:
    host = Driven()
    host.wake()
    host.wake()
    assert host.network.clock_us == 2 * READY_REPORT_US
    assert host.sent == 4 * [sync.ACTUAL]
    assert [report.components[0].state for report in host.reports] == ["init", "running", "running", "running"]


def test_due_report_waits_for_the_end_of_a_stage() -> None:
    host = Driven()
    host.tick(1, 50_000)
    host.wake()  # the interval before the first tick ends
    host.sent.clear()
    due_us = host.network.clock_us + REPORT_US
    host.tick(2, due_us - 1)
    host.tick(3, due_us + 40_000)
    assert host.sent == [sync.DONE, sync.DONE, sync.ACTUAL]
    assert host.reports[-1].components[0].iterations == 3


def test_host_without_ticks_reports_all_the_same() -> None:
    host = Driven()
    host.tick(1, 50_000)
    host.wake()
    began_us = host.network.clock_us
    host.sent.clear()
    host.wake()
    assert host.network.clock_us == began_us + REPORT_US + TICK_AWAITED_US
    assert host.sent == [sync.ACTUAL]
