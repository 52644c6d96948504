"""A C program built from the project's .lcm files alone reads the bus."""

import re
import subprocess
from collections.abc import Callable
from pathlib import Path

import lcm
import pytest

from fwk.lcm.event_log import LogReader
from fwk.recording.compare import FRAMEWORK
from tests.clients.bus import Bus, process, program
from tests.fwk.recording.recording_made import entry, world_model
from tests.harness.fixtures import Launch, launch
from tests.harness.runs import PortBlock

__all__ = ["launch"]

pytestmark = pytest.mark.system
ROOT = Path(__file__).parents[2]
WHEEL = Path(lcm.__file__).parent.parent


@pytest.fixture(scope="module")
def ball(tmp_path_factory: pytest.TempPathFactory) -> Callable[[], str]:
    """Builds the program on first use; all message types compile without a warning."""
    folder = tmp_path_factory.mktemp("ball")

    def build() -> str:
        if not (folder / "ball").exists():
            types = map(str, sorted((ROOT / "lcmtypes").glob("*.lcm")))
            made, build = folder / "types", folder / "build"
            made.mkdir()
            build.mkdir()
            subprocess.run([program("lcm-gen"), "-c", "--c-cpath", made, "--c-hpath", made, *types], check=True)
            types_c = build / "types.c"  # one unit: the headers of the system are read once, not sixty times
            types_c.write_text("".join(f'#include "{file.name}"\n' for file in sorted(made.glob("*.c"))))
            (folder / "tools").symlink_to(ROOT / "tools")
            (line,) = re.findall(r"^//   cc (.*)$", (ROOT / "tools/clients/ball.c").read_text(), re.MULTILINE)
            paths = f"-I{made} -I{WHEEL}/include -L{WHEEL}/lib -Wl,-rpath,{WHEEL}/lib"
            subprocess.run(f"cc -Wall -Werror {paths} {line}", shell=True, cwd=folder, check=True)
        return str(folder / "ball")

    return build


def test_the_c_program_prints_the_ball_of_a_robot(
    ball: Callable[[], str], needs: Callable[..., None], ports: PortBlock
) -> None:
    needs("cc")
    bus = Bus(ports.public_url)
    channel, data, _ = entry("cyan1/world_model", world_model(7, 1), 7)
    unknown = world_model(8, 1)
    unknown.ball.known = False
    with process([ball(), "cyan1", bus.url, "1"]) as started:
        bus.publish_until(lambda: started.poll() is not None, data, channel)
        assert started.stdout
        assert started.stdout.read() == (
            "cyan1/world_model tick 7: ball at (0.70, 0.00) m, moving (2.00, 0.00) m/s, seen 0.00 s ago\n"
        )
    with process([ball(), "cyan1", bus.url, "1"]) as started:
        bus.publish_until(lambda: started.poll() is not None, entry(channel, unknown, 8)[1], channel)
        assert started.stdout
        assert started.stdout.read() == "cyan1/world_model tick 8: ball unknown\n"
        assert started.returncode == 0


def test_wrong_arguments_are_explained(ball: Callable[[], str], needs: Callable[..., None]) -> None:
    needs("cc")
    result = subprocess.run([ball()], capture_output=True, text=True, check=False)
    assert result.returncode == 2
    assert "usage: " in result.stderr


def test_c_program_and_lcm_logger_hear_a_running_robot(
    ball: Callable[[], str], needs: Callable[..., None], ports: PortBlock, launch: Launch, tmp_path: Path
) -> None:
    needs("cc")
    bus = Bus(ports.public_url)
    one = (ROOT / "launch" / "one-robot.yaml").read_text()
    (tmp_path / "one.yaml").write_text(one.replace("stereo", "percepts"))  # pictures take most of the processor time
    options = ("--ticks", "120", "--speed", "5", "--set", f"public_url={bus.url}", "--record", "own")
    with process([ball(), "cyan1", bus.url, "100"]) as printing, bus.logger(tmp_path / "heard"):
        assert (run := launch("one.yaml", *options)).wait() == 0, run.text
        assert printing.wait(30) == 0
        assert printing.stdout
        lines = printing.stdout.read().splitlines()
    assert len(lines) == 100
    assert all(line.startswith("cyan1/world_model tick ") for line in lines)
    assert any("ball at (" in line for line in lines)
    own, heard = said(tmp_path / "own"), said(tmp_path / "heard")
    assert {channel for channel, _ in heard} == {channel for channel, _ in own}
    assert set(heard) <= set(own)  # byte for byte
    assert len(set(heard)) > 0.9 * len(set(own))  # the public bus may lose some on a busy machine


def said(log: Path) -> list[tuple[str, bytes]]:
    """Messages that components published."""
    ours = [event for event in LogReader(log) if "/" in event.channel and not event.channel.startswith(FRAMEWORK)]
    return [(event.channel, event.data) for event in ours]
