"""Actuators in a running match: a stopped driver leaves them at rest, a killed one lets them time out."""

import math
import os
import signal
from pathlib import Path

import pytest

from fwk.control import runs
from fwk.model.tick_events import HostLost, HostStopped
from lcmtypes.core import header_t
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

LAUNCH = Path(__file__).parents[3] / "launch"
TICKS_PER_S = 20
BRAKING_S = 0.8  # from full speed, with the motors' lag
TIMEOUT_OF_MOTORS_S = 0.25
STANDING_M_S = 0.02


@pytest.fixture
def match(launch: Launch, ports: PortBlock, tmp_path: Path) -> Steered:
    """One moving robot on the field; its base is not restarted when it dies."""
    robot = (LAUNCH / "msl-percepts.yaml").read_text()  # without pictures, which take most of the processor time
    (tmp_path / "msl-percepts.yaml").write_text(
        robot.replace("use: procs.drivers.base\n", "use: procs.drivers.base\n      restart: {when: never}\n")
    )
    one = (LAUNCH / "one-robot.yaml").read_text()
    (tmp_path / "one.yaml").write_text(one.replace("stereo", "percepts"))
    return Steered(launch("one.yaml", "--speed", "max", "--set", f"public_url={ports.public_url}"), ports)


def drive(match: Steered, ports: PortBlock) -> None:
    """Waits until the robot is fast."""

    def fast() -> bool:
        with runs.gateway(ports.bus) as run:
            truth = run.ask("show", channel="world/ground_truth")["value"]
        return truth is not None and math.hypot(truth["robots"][0]["vx_m_s"], truth["robots"][0]["vy_m_s"]) > 0.5

    match.launched.until_true(fast, "a fast robot")


def speeds_m_s(recording: Recording) -> dict[int, float]:
    """Returns the speeds of the robot by tick."""
    truths = recording.decoded("world/ground_truth")
    return {each.header.tick: math.hypot(each.robots[0].vx_m_s, each.robots[0].vy_m_s) for each in truths}


def tick_of(recording: Recording, event: HostLost | HostStopped) -> int:
    """Returns the tick of an event that happened once."""
    (tick,) = [tick for tick, each in recording.events if each == event and type(each) is type(event)]
    return tick


def index_of(match: Steered, name: str) -> int:
    names = [each["name"] for each in match.ask("status")["components"]]
    return names.index(name)


def test_a_stopped_base_stops_the_robot_and_comes_back(match: Steered, ports: PortBlock) -> None:
    base = index_of(match, "cyan1/base")
    drive(match, ports)
    match.steer("stop", "cyan1/base")
    match.ticks_pass(2 * TICKS_PER_S)
    match.steer("start", "cyan1/base")
    match.ticks_pass(TICKS_PER_S)
    log = match.end()
    recording = Recording(log)
    stopped = tick_of(recording, HostStopped(base))
    (last,) = [each for each in recording.decoded("cyan1/wheel_command") if each.header.stage == header_t.FINAL]
    assert last.header.tick == stopped - 1
    assert tuple(last.wheel_m_s) == (0.0, 0.0, 0.0)
    speeds = speeds_m_s(recording)
    standing = range(stopped + round(BRAKING_S * TICKS_PER_S), stopped + 2 * TICKS_PER_S)
    assert max(speeds[tick] for tick in standing) < STANDING_M_S
    assert recording.gaps() == {}
    replayed(log.parent, log=log)


def test_a_killed_base_lets_the_motors_time_out(match: Steered, ports: PortBlock) -> None:
    base = index_of(match, "cyan1/base")
    drive(match, ports)
    os.kill(match.component("cyan1/base")["pid"], signal.SIGKILL)
    match.launched.until("cyan1/base ended: killed by signal 9")
    match.ticks_pass(2 * TICKS_PER_S)
    match.launched.signal(signal.SIGINT)
    assert match.launched.wait() == 1, match.launched.text  # a component has failed
    recording = Recording(match.launched.run_dir / "log.lcm")
    lost, speeds = tick_of(recording, HostLost(base)), speeds_m_s(recording)
    standing = lost + round((TIMEOUT_OF_MOTORS_S + BRAKING_S) * TICKS_PER_S)
    assert speeds[lost - 1] > STANDING_M_S
    assert max(speed for tick, speed in speeds.items() if tick >= standing) < STANDING_M_S


@pytest.mark.parametrize("clock", ["simulated", "wall"])
@pytest.mark.core
def test_messages_of_finalize_are_seen_recorded_and_replayed(
    launch: Launch, ports: PortBlock, tmp_path: Path, clock: str
) -> None:
    write_system(tmp_path, ports)
    write_files(tmp_path, sources("final_words.py"))
    small = (tmp_path / "small.yaml").read_text()
    assert "small:Counter" in small
    (tmp_path / "small.yaml").write_text(small.replace("small:Counter", "final_words:LastWords"))
    with (tmp_path / "small.yaml").open("a") as file:
        file.write(f"clock: {clock}\nstage_time_s: 0.2\n")
    run = Steered(launch("small.yaml"), ports)
    run.steer("stop", "r/counter")
    run.ticks_pass()
    run.steer("start", "r/counter")
    run.ticks_pass()
    run.steer("restart", "r/counter")
    run.ticks_pass()
    log = run.end()
    recording = Recording(log)
    assert recording.gaps() == {}
    stops = [tick for tick, each in recording.events if isinstance(each, HostStopped) and each.host == 0]
    last = [each.header for each in recording.decoded("r/imu") if each.heading_rad == -1.0]
    assert [header.stage for header in last] == [header_t.FINAL] * 2  # no component would see that of the end
    seen = [each.header.tick for each in recording.decoded("r/pose") if each.heading_rad == -1.0]
    if clock == "simulated":
        assert [header.tick for header in last] == [tick - 1 for tick in stops]
        assert stops[0] in seen  # in the first tick without the writer
    assert seen
    replayed(log.parent, log=log)
