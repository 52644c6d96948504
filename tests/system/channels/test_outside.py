"""Programs outside write channels of a run: stamped, seen once, fetched, recorded, and replayed byte for byte."""

import os
import signal
from pathlib import Path

import lcm
import pytest

from fwk.control.address import gateway_address
from fwk.control.client import Client
from lcmtypes.robot import motor_command_t
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import TIMEOUT_S, PortBlock, write_files
from tests.programs.control_system import Steered
from tests.programs.outside_system import outside_system

pytestmark = pytest.mark.system

FILE = "joystick.yaml"
WISHES = 40
SIMULATED, WALL = "period_s: 0.01", "period_s: 0.02\nclock: wall\nstage_time_s: 0.1"


class Joystick:
    """A program with nothing but LCM and the type; counts its messages that the run has taken."""

    def __init__(self, ports: PortBlock, run: Steered) -> None:
        self._bus = lcm.LCM(ports.public_url)
        self._ports = ports
        self._run = run
        self.published = 0

    def wish(self, times: int = 1) -> None:
        """Publishes a value, waits until the run has recorded it, and repeats."""
        for _ in range(times):
            self.published += 1
            self.publish(float(self.published))
            self._run.launched.until_true(lambda: self.taken >= self.published, f"wish {self.published}")

    def publish(self, vx_m_s: float) -> None:
        message = motor_command_t()
        message.vx_m_s = vx_m_s
        self._bus.publish("r/wish", message.encode())

    @property
    def taken(self) -> int:
        with Client(gateway_address(self._ports.bus), TIMEOUT_S) as client:
            return int(client.ask("show", channel="r/wish")["sequence"])


def checked(run: Steered, log: Path, published: int) -> Recording:
    """Returns the recording of a run that has taken that many values, after a replay."""
    recording = Recording(log)
    assert recording.gaps() == {}
    headers = recording.headers("r/wish")
    assert [(header.sequence, header.writer, header.stage) for header in headers] == [
        (number, "outside", -1) for number in range(1, published + 1)
    ]
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")
    return recording


@pytest.mark.parametrize("time", [SIMULATED, WALL], ids=["lockstep", "real time"])
@pytest.mark.parametrize("loss", ["0", "0.3"])
def test_every_outside_message_is_recorded_once_and_replayed(
    launch: Launch, tmp_path: Path, ports: PortBlock, loss: str, time: str
) -> None:
    write_files(tmp_path, outside_system(ports.public_url, time))
    run = Steered(launch(FILE, env={"FWK_TEST_LOSS": loss}), ports)
    joystick = Joystick(ports, run)
    joystick.wish(WISHES)
    run.ticks_pass(5)
    recording = checked(run, run.end(), WISHES)
    for name in ("r", "s") if time == SIMULATED else ():  # in real time an absence costs messages
        assert recording.decoded(f"{name}/total")[-1].heading_rad == WISHES * (WISHES + 1) / 2
        assert recording.decoded(f"{name}/recent")[-1].heading_rad == WISHES + WISHES - 1 + WISHES - 2
    assert [wish.vx_m_s for wish in recording.decoded("r/wish")] == [float(n) for n in range(1, WISHES + 1)]
    assert "somebody else" not in run.launched.text


def test_a_restarted_reader_has_the_newest_outside_message(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, outside_system(ports.public_url, SIMULATED))
    run = Steered(launch(FILE), ports)
    Joystick(ports, run).wish(5)
    run.steer("restart", "r/obeys")
    run.ticks_pass(3)
    recording = checked(run, run.end(), 5)
    again = [
        message.heading_rad
        for message, header in zip(recording.decoded("r/total"), recording.headers("r/total"), strict=True)
        if header.writer == "r/obeys#2"
    ]
    assert again[0] == again[-1] == 5.0


def test_a_flood_from_outside_is_bounded_and_reported(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, outside_system(ports.public_url, SIMULATED))
    run = Steered(launch(FILE), ports)
    joystick = Joystick(ports, run)
    os.kill(run.launched.process.pid, signal.SIGSTOP)  # no tick can take anything in between
    for _ in range(64 + 100):
        joystick.publish(1.0)
    run.launched.until("64 messages wait for the next tick already; refused (100 times)")
    os.kill(run.launched.process.pid, signal.SIGCONT)
    run.launched.until_true(lambda: joystick.taken == 64, "what fits into a tick")
    joystick.published = 64
    joystick.wish()
    checked(run, run.end(), 65)


def test_fwk_send_is_an_outside_program(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, outside_system(ports.public_url, SIMULATED))
    run = Steered(launch(FILE), ports)
    joystick = Joystick(ports, run)
    sent = run.json("send", "r/wish", "vx_m_s=2.5")
    assert (sent["channel"], sent["type"]) == ("r/wish", "robot.motor_command_t")
    run.launched.until_true(lambda: joystick.taken == 1, "what was sent")
    run.ticks_pass(3)
    recording = checked(run, run.end(), 1)
    assert recording.decoded("s/total")[-1].heading_rad == 2.5


def test_fwk_send_stands_in_for_a_left_out_writer(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, outside_system(ports.public_url, SIMULATED))
    run = Steered(launch(FILE, "--without", "s/obeys", "--outside", "s/*"), ports)
    said = run.fwk("send", "r/total", "heading_rad=1.0", code=2)
    assert "r/total: r/obeys writes it; to write it yourself, start the run with --without r/obeys --outside" in said
    assert "or name it under 'outside:' in a launch file without r/obeys" in said
    run.fwk("send", "s/total", "heading_rad=2.5")
    run.launched.until_true(lambda: run.json("bb", "show", "s/total")["sequence"] == 1, "what was sent")
    log = run.end()
    (sent,) = Recording(log).decoded("s/total")
    assert (sent.heading_rad, sent.header.writer) == (2.5, "outside")
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")
