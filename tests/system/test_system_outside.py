"""Programs outside write into a run: checked, stamped between ticks, recorded, and replayed exactly."""

from pathlib import Path

import pytest
from lcm import LCM

from lcmtypes.robot import imu_t, odometry_t
from tests.system.conftest import Launch
from tests.system.control_system import Steered
from tests.system.system_logs import Recording
from tests.system.system_orchestra import WEATHER
from tests.system.system_runs import PortBlock, pause, write_files

pytestmark = pytest.mark.system

ECHO = '''
"""Says what it has heard from outside, and how often."""

import procs.weather

from fwk import Component, Reads, Writes, channel
from lcmtypes.robot import odometry_t


class Echo(Component):
    """Adds up wishes."""

    stage = "think"
    wish: Reads[odometry_t] = channel("a/wish")
    heard: Writes[odometry_t]

    def init(self) -> None:
        self.count = 0

    def loop(self) -> None:
        for wish in self.wish.fresh:
            self.count += 1
            self.heard.value.x_m += wish.x_m
        self.heard.value.heading_rad = float(self.count)
        self.heard.write()
'''

LAUNCH = """
name: outside
period: 0.02
public_url: {url}
components:
  a/echo: {{use: procs.echo}}
  b/echo: {{use: procs.echo}}
outside:
  a/wish: robot.odometry_t
"""


@pytest.fixture
def run(tmp_path: Path, ports: PortBlock, launch: Launch, request: pytest.FixtureRequest) -> Steered:
    """A running system with two components that listen to the outside; a parameter says which share gets lost."""
    text = LAUNCH.format(url=ports.public_url)
    write_files(tmp_path, {"procs/echo.py": ECHO, "procs/weather.py": WEATHER, "launch/outside.yaml": text})
    loss = {"FWK_TEST_LOSS": str(getattr(request, "param", 0))}
    return Steered(launch("launch/outside.yaml", env=loss), ports)


def wish(x_m: float) -> bytes:
    """What a program outside writes: it knows nothing of ticks."""
    made = odometry_t()
    made.x_m = x_m
    made.header.writer, made.header.sequence = "somebody", 77
    return made.encode()


def say_until_heard(run: Steered, ports: PortBlock, data: bytes, count: int) -> None:
    """Publishes on the public bus until the components have heard so many of them."""
    bus = LCM(ports.public_url)

    def heard() -> bool:
        bus.publish("a/wish", data)
        pause()
        return float(run.json("bb", "show", "a/heard")["value"]["heading_rad"]) >= count

    run.launched.until_true(heard, f"{count} messages heard")


@pytest.mark.parametrize("run", [0, 0.1], indirect=True)
def test_what_is_written_outside_is_heard_stamped_recorded_and_replayed(run: Steered, ports: PortBlock) -> None:
    run.ticks_pass()
    say_until_heard(run, ports, wish(0.5), 5)
    run.ticks_pass(20)
    log = run.end()
    recording = Recording(log)
    headers = recording.headers("a/wish")
    assert not recording.gaps()
    assert {header.writer for header in headers} == {"outside"}
    assert {header.stage for header in headers} == {-1}
    assert [header.tick for header in headers] == sorted(header.tick for header in headers)
    for each in "ab":
        assert recording.decoded(f"{each}/heard")[-1].x_m == 0.5 * len(headers)
    assert "equal" in run.fwk("replay", str(log), "--verify")


def test_what_is_no_such_message_is_refused_by_name(run: Steered, ports: PortBlock) -> None:
    run.ticks_pass()
    bus = LCM(ports.public_url)
    for data in (b"", b"rubbish", wish(1.0)[:-1], imu_t().encode()):
        bus.publish("a/wish", data)
    bus.publish("a/heard", wish(9.0))
    say_until_heard(run, ports, wish(0.5), 1)
    run.launched.until("a/wish: not a robot.odometry_t")
    run.launched.until("a/heard: somebody else")
    log = run.end()
    assert {each.x_m for each in Recording(log).decoded("a/wish")} == {0.5}


def test_a_flood_is_cut_short_and_said(run: Steered, ports: PortBlock) -> None:
    run.ticks_pass()
    bus, data = LCM(ports.public_url), wish(1.0)

    def said() -> bool:
        for _ in range(500):
            bus.publish("a/wish", data)
        return "a/wish: more than" in run.launched.text

    run.launched.until_true(said, "the flood is named")
    log = run.end()
    assert not Recording(log).gaps()
    assert "equal" in run.fwk("replay", str(log), "--verify")
