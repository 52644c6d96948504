"""Devices with LCM types of their own, one of them a C program: heard, obeyed, recorded and replayed byte for byte."""

import json
import os
import signal
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import lcm
import pytest

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogReader, LogWriter
from fwk.lcm.messages import Header, type_named
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import use_types_of
from fwk.recording.replay.recording import Recording
from tests.clients.bus import Bus, process, program, wait_until
from tests.harness.components import source, sources
from tests.harness.fixtures import Launch
from tests.harness.logs import difference
from tests.harness.runs import Launched, PortBlock, fwk, replayed, write_files
from tests.programs.control_system import Steered
from tests.programs.device_system import device_system

pytestmark = pytest.mark.system

SIMULATED, WALL = "period_s: 0.02", "period_s: 0.02\nclock: wall\nstage_time_s: 0.1"
WHEEL = Path(lcm.__file__).parent.parent
SOURCE = Path(__file__).parents[2] / "clients/device.c"
COUNT = 20


@pytest.fixture(scope="session", autouse=True)
def _device_types(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("device_types")
    write_files(folder, sources("lcmtypes/devices.lcm"))
    use_types_of(folder)


@pytest.fixture(scope="session")
def build(tmp_path_factory: pytest.TempPathFactory) -> Callable[[], str]:
    """Builds the device from its own types alone on first use."""
    folder = tmp_path_factory.mktemp("device")

    def built() -> str:
        if not (folder / "device").exists():
            (folder / "devices.lcm").write_text(source("lcmtypes/devices.lcm").partition("struct stamped_t")[0])
            command = [program("lcm-gen"), "-c", "--c-cpath", str(folder), "--c-hpath", str(folder)]
            subprocess.run([*command, str(folder / "devices.lcm")], check=True)
            paths = [f"-I{folder}", f"-I{WHEEL}/include", f"-L{WHEEL}/lib", f"-Wl,-rpath,{WHEEL}/lib"]
            sources = [str(SOURCE), *map(str, folder.glob("*.c"))]
            subprocess.run(["cc", "-Wall", "-Werror", *paths, "-o", folder / "device", *sources, "-llcm"], check=True)
        return str(folder / "device")

    return built


@pytest.fixture
def device(build: Callable[[], str], needs: Callable[..., None]) -> str:
    needs("cc")
    return build()


def started(launch: Launch, tmp_path: Path, ports: PortBlock, time: str = SIMULATED) -> Steered:
    write_files(tmp_path, device_system(ports.public_url, time))
    return Steered(launch("device.yaml"), ports)


def obeyed(run: Steered, device: str, ports: PortBlock) -> None:
    """The device beside a run, until the run has obeyed its last message."""
    with process([device, ports.public_url, str(COUNT)]) as running:
        run.launched.until_true(lambda: running.poll() is not None, "the device's end")
        assert running.stdout
        assert running.stdout.read() == f"obeyed {COUNT}\n"


def headers(log: Path, channel: str) -> list[Header]:
    return [Header.of(event.data) for event in StampedLog(log) if event.channel == channel]


def plain(log: Path, channel: str, name: str) -> list[Any]:
    """Returns the messages as any LCM program finds them in the log."""
    return [type_named(name).decode(event.data) for event in LogReader(log) if event.channel == channel]


@pytest.mark.parametrize("time", [SIMULATED, WALL], ids=["lockstep", "real time"])
def test_a_c_program_exchanges_messages_and_replays(
    launch: Launch, tmp_path: Path, ports: PortBlock, device: str, time: str
) -> None:
    run = started(launch, tmp_path, ports, time)
    obeyed(run, device, ports)
    log = run.end()
    joys = plain(log, "JOYSTICK", "devices.joy_t")
    assert sorted({joy.utime for joy in joys}) == list(range(1, COUNT + 1))
    assert {(joy.name, joy.n_axes, joy.axes[0]) for joy in joys} == {("stick", 3, 0.5)}
    stamps = headers(log, "JOYSTICK")
    assert [(each.sequence, each.stage, each.writer) for each in stamps] == [
        (number, -1, "outside") for number in range(1, len(joys) + 1)
    ]
    motors = plain(log, "MOTORS", "devices.motor_t")
    assert motors[-1].power[0] == 0.25 * COUNT
    assert [each.sequence for each in headers(log, "MOTORS")] == list(range(1, len(motors) + 1))
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")
    assert "somebody else" not in run.launched.text


@pytest.mark.parametrize("time", [SIMULATED, WALL], ids=["lockstep", "real time"])
def test_a_killed_reader_goes_on_and_the_recording_replays(
    launch: Launch, tmp_path: Path, ports: PortBlock, device: str, time: str
) -> None:
    run = started(launch, tmp_path, ports, time)
    obeyed(run, device, ports)
    first = (tmp_path / "driver.pid").read_text()
    os.kill(int(first), signal.SIGKILL)
    run.launched.until_true(lambda: (tmp_path / "driver.pid").read_text() not in ("", first), "the next driver")
    obeyed(run, device, ports)
    run.ticks_pass(3)
    log = run.end()
    writers = [each.writer for each in headers(log, "MOTORS")]
    assert list(dict.fromkeys(writers)) == ["r/driver", "r/driver#2"]
    assert [each.sequence for each in headers(log, "MOTORS")] == list(range(1, len(writers) + 1))
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")


@pytest.fixture
def alone(launch: Launch, tmp_path: Path, ports: PortBlock) -> Callable[..., Launched]:
    """Runs the system without its device for 40 ticks into that log."""
    write_files(tmp_path, device_system(ports.public_url))

    def run(log: str, *arguments: str) -> Launched:
        made = launch("device.yaml", "--ticks", "40", "--speed", "max", "--record", log, *arguments)
        assert made.wait() == 0, made.text
        return made

    return run


def test_a_changed_component_is_found_by_the_replay(alone: Callable[..., Launched], tmp_path: Path) -> None:
    alone("log.lcm")
    replayed(tmp_path)
    file = tmp_path / "device_parts.py"
    text = file.read_text()
    changed = "            part.value.power = [*motor.power[:1], motor.power[1] + (self.clock.tick == 17)]"
    file.write_text(text.replace("            part.value.power = motor.power", changed))
    said = replayed(tmp_path, code=1)
    assert "r/driver: left/parts: tick 17, stage 5, message 33 by r/driver: power[1] is -0.17 in" in said
    file.write_text(text.replace("part.write()\n            part.write()", "part.write()"))
    assert "left/parts: tick 1, stage 5, message 2 by r/driver: there in" in fwk(
        tmp_path, "replay", "log.lcm", "--verify", code=1
    )


@pytest.mark.parametrize(
    ("kept", "said"),
    [
        pytest.param(slice(0), "MOTORS has a message without the stamp that holds its header", id="no stamp"),
        pytest.param(slice(-2), "MOTORS has a message without the stamp that holds its header", id="half a stamp"),
    ],
)
def test_a_recording_without_stamps_is_refused(
    alone: Callable[..., Launched], tmp_path: Path, kept: slice, said: str
) -> None:
    alone("log.lcm")
    with LogWriter(tmp_path / "without.lcm", pytest.fail) as log:
        for event in LogReader(tmp_path / "log.lcm"):
            data = event.data[kept] if event.channel == STAMP else event.data
            log.append(event.channel, data, event.time_us)
    assert said in replayed(tmp_path, log="without.lcm", code=2)


def test_layouts_give_the_same_and_other_settings_do_not(alone: Callable[..., Launched], tmp_path: Path) -> None:
    alone("process.lcm", "--hosting", "process")
    alone("single.lcm", "--hosting", "single")
    assert difference(tmp_path / "process.lcm", tmp_path / "single.lcm") == ""
    assert len(plain(tmp_path / "single.lcm", "right/parts", "devices.motor_t")) == 80
    alone("other.lcm", "--set", "r/driver.gain=2")
    said = fwk(tmp_path, "compare", "process.lcm", "other.lcm", code=1)
    assert "MOTORS: tick 1, stage 5, message 1 by r/driver: power[0] is 0.01 in process.lcm, 0.02 in other.lcm" in said


def test_listeners_hear_each_message_to_a_part_once(alone: Callable[..., Launched], tmp_path: Path) -> None:
    alone("log.lcm")
    heard = type_named("robot.imu_t").decode(
        [event.data for event in LogReader(tmp_path / "log.lcm") if event.channel == "s/heard"][-1]
    )
    assert heard.heading_rad == pytest.approx(-2 * 2 * sum(0.01 * tick for tick in range(1, 41)))
    assert heard.yaw_rate_rad_s == 40 * 2 * 11


def test_malformed_device_messages_are_refused_and_counted(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    run = started(launch, tmp_path, ports)
    bus = lcm.LCM(ports.public_url)
    joy: Any = type_named("devices.joy_t")()
    joy.utime, joy.name = 7, "stick"
    whole = joy.encode()
    for data in (whole[:-3], type_named("devices.motor_t")().encode(), whole + b"!", b""):
        bus.publish("JOYSTICK", data)
    run.launched.until("JOYSTICK: from port ")
    for _ in range(10):
        bus.publish("JOYSTICK", whole[:20])
    run.launched.until("(10 times)")
    assert run.json("bb", "show", "JOYSTICK")["sequence"] == 0
    bus.publish("MOTORS", type_named("devices.motor_t")().encode())
    run.launched.until("MOTORS: another program (port ")
    bus.publish("JOYSTICK", whole)
    run.launched.until_true(lambda: run.json("bb", "show", "JOYSTICK")["sequence"] == 1, "the right one")
    run.ticks_pass(3)
    assert "by outside\n  utime: 7\n" in run.fwk("bb", "show", "JOYSTICK")
    assert "by r/driver\n  utime: 7\n" in run.fwk("bb", "show", "MOTORS")
    about = json.loads(fwk(tmp_path, "log-info", str(run.end()), "--json", code=0))["channels"]["JOYSTICK"]
    assert (about["types"], about["writers"], about["messages"]) == (["devices.joy_t"], ["outside"], 1)
    assert (about["lost"], about["undecodable"]) == (0, 0)


def test_lcm_logplayer_plays_the_recording_to_any_program(
    launch: Launch, tmp_path: Path, ports: PortBlock, device: str
) -> None:
    run = started(launch, tmp_path, ports)
    assert "JOYSTICK: " in run.fwk("send", "JOYSTICK", "utime=9", "axes=[1.0, 2.0]", "name=sent")
    run.launched.until_true(lambda: run.json("bb", "show", "MOTORS")["value"]["utime"] == 9, "obedience")
    log = run.end()
    bus = Bus(ports.public_url)
    heard = tmp_path / "heard.txt"
    with open(heard, "w") as output:
        listening = subprocess.Popen([device, bus.url], stdout=output)
        try:
            ready: Any = type_named("devices.motor_t")()
            bus.publish_until(lambda: "MOTORS 0: " in heard.read_text(), ready.encode(), "MOTORS")
            bus.play(log, "--speed=50")
            wait_until(lambda: "MOTORS 9: 2.00 -2.00" in heard.read_text(), "nothing of the end was heard")
        finally:
            listening.kill()
            listening.wait()
    assert "JOYSTICK 9: 2 axes, sent" in heard.read_text()


def test_lcm_logger_hears_what_the_recording_holds(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, device_system(ports.public_url))
    bus = Bus(ports.public_url)
    with bus.logger(tmp_path / "heard.lcm"):
        run = launch("device.yaml", "--ticks", "30", "--record", "own.lcm")
        assert run.wait() == 0, run.text
    assert difference(tmp_path / "own.lcm", tmp_path / "heard.lcm") == ""
    assert Recording(tmp_path / "own.lcm").plan.outside == {"JOYSTICK": "devices.joy_t"}
