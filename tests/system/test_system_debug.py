"""One component under pdb in a real terminal: the world waits, and the recording shows nothing of it."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pexpect
import pytest

from fwk.clock import sleep_s
from fwk.record.compare import Comparison
from tests.system.system_runs import PortBlock, write_files

pytestmark = pytest.mark.system

FILES = {
    "parts.py": '''
"""A sensor, a world model and a thinker."""

from pathlib import Path

from fwk import Component, Reads, Writes
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class Sensor(Component):
    """Turns."""

    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 0.1
        self.imu.write()
        Path("turns.txt").write_text(str(self.imu.value.header.tick))


class WorldModel(Component):
    """Believes."""

    stage = "worldstate"
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.heading_rad = self.imu.value.heading_rad
        self.pose.write()
''',
    "parts.yaml": """
name: parts
components:
  r/sensor: {use: "parts:Sensor"}
  r/world_model: {use: "parts:WorldModel"}
""",
}
LOOP_LINE = 1 + next(n for n, line in enumerate(FILES["parts.py"].splitlines()) if "self.pose.value.heading" in line)
COMMAND = [sys.executable, "-m", "fwk.cli.launch", "parts.yaml", "--ticks", "40", "--speed", "max"]


class Terminal:
    """`fwk-launch parts.yaml` in a terminal."""

    def __init__(self, folder: Path, ports: PortBlock, *arguments: str) -> None:
        self._folder = folder
        where = ["--bus-port", str(ports.bus), "--set", f"public_url={ports.public_url}"]
        command = [*COMMAND, *where, *arguments]
        self.child = pexpect.spawn(command[0], command[1:], cwd=folder, timeout=30, encoding="utf-8")

    def kill(self) -> None:
        self.child.close(force=True)

    def type(self, line: str) -> None:
        self.child.sendline(line)

    def prompt(self) -> str:
        self.child.expect(r"\(Pdb\) ")
        return str(self.child.before)

    def end(self) -> int:
        self.child.expect(pexpect.EOF)
        self.child.close()
        return int(self.child.exitstatus)

    @property
    def turns(self) -> int:
        """Ticks that the sensor has run."""
        file = self._folder / "turns.txt"
        return int(file.read_text() or 0) if file.exists() else 0


Open = Callable[..., Terminal]


@pytest.fixture
def terminal(tmp_path: Path, ports: PortBlock) -> Iterator[Open]:
    write_files(tmp_path, FILES)
    opened: list[Terminal] = []

    def start(*arguments: str) -> Terminal:
        opened.append(Terminal(tmp_path, ports, *arguments))
        return opened[-1]

    yield start
    for each in opened:
        each.kill()


def test_while_one_component_is_stopped_nobody_goes_on_and_nothing_shows_in_the_recording(
    terminal: Open, tmp_path: Path
) -> None:
    assert terminal("--record", "free.log").end() == 0
    debugged = terminal("--debug", "r/world_model", "--record", "stopped.log")
    assert "loop()" in debugged.prompt()
    debugged.type(f"tbreak {LOOP_LINE}")
    debugged.prompt()
    debugged.type("c")
    debugged.prompt()
    debugged.type("p self.imu.value.header.tick")
    assert "2" in debugged.prompt()
    sleep_s(0.5)
    assert debugged.turns == 2
    debugged.type("c")
    assert debugged.end() == 0
    assert debugged.turns == 40
    compared = Comparison(tmp_path / "free.log", tmp_path / "stopped.log", False)
    assert compared.difference is None
    assert compared.messages == 80


def test_leaving_the_debugger_gives_the_component_back(terminal: Open) -> None:
    debugged = terminal("--debug", "r/world_model")
    debugged.prompt()
    debugged.type("q")
    debugged.child.expect("r/world_model runs again, start number 2")
    assert debugged.end() == 0
    assert debugged.turns == 40


def test_ctrl_c_stops_in_the_debugged_component_and_not_the_run(terminal: Open) -> None:
    debugged = terminal("--debug", "r/world_model", "--ticks", "100000")
    debugged.prompt()
    debugged.type("c")
    while debugged.turns < 5:
        sleep_s(0.05)
    debugged.child.sendintr()
    debugged.prompt()
    before = debugged.turns
    sleep_s(0.5)
    assert debugged.turns <= before + 1
    debugged.type("q")
    debugged.child.expect("runs again")
    debugged.child.sendintr()
    assert debugged.end() == 0
