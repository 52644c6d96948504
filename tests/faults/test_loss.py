"""Datagrams get lost, and buffers are far too small: lockstep shows nothing of it."""

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, TICKS
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording, difference
from tests.harness.runs import PortBlock, write_files
from tests.programs.orchestra import WEATHER

pytestmark = pytest.mark.system

SMALL = {"FWK_TEST_BUFFER_BYTES": "8192"}


def lossy(share: str) -> tuple[tuple[str, ...], dict[str, str]]:
    """What makes datagrams get lost: a network of its own in the kernel, or the senders where that is not allowed."""
    drop = f"iptables -A INPUT -i lo -p udp -m statistic --mode random --probability {share} -j DROP"
    shell = ("unshare", "-rn", "sh", "-c", f'ip link set lo up && {drop} && exec "$0" "$@"')
    if shutil.which("unshare") and not subprocess.run([*shell, "true"], capture_output=True, check=False).returncode:
        return shell, SMALL
    return (), {"FWK_TEST_LOSS": share, **SMALL}


@pytest.mark.parametrize("share", ["0.05", pytest.param("0.2", marks=pytest.mark.slow)])
def test_lost_datagrams_and_buffers_of_8_kib_change_nothing(
    launch: Launch, traced: Path, undisturbed: Path, after: Aftermath, share: str
) -> None:
    wrapper, env = lossy(share)
    run = launch(*RUN, "--ticks", str(TICKS), env=env, wrapper=wrapper)
    run.until_ticks("f/player", 2)
    after.note(run)
    recording = after.check(run, equal_to=undisturbed, replays=False)
    assert recording.gaps() == {}
    assert "lost 0" in run.text
    assert "fetched" in run.text


RESTARTED = '''
"""One that is started anew again and again and speaks until its end, and one that hears it."""

import zlib

import weather
from fwk import Clock, Component, PluginControl, Reads, Writes
from lcmtypes.robot import imu_t


class Talker(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]

    def loop(self) -> None:
        self.imu.value.heading_rad += 1.0
        self.imu.write()

    def finalize(self) -> None:
        self.imu.value.heading_rad = -1.0
        self.imu.write()


class Listener(Component):
    stage = "think"
    clock: Clock
    plugins: PluginControl
    imu: Reads[imu_t]
    heard: Writes[imu_t]

    def loop(self) -> None:
        for message in self.imu.fresh:
            self.heard.value.heading_rad = float(zlib.crc32(message.encode() + b"%r" % self.heard.value.heading_rad))
        self.heard.write()
        if self.clock.tick % 2:
            self.plugins.restart("r/talker")
'''
LAUNCH = """
name: restarted
speed: max
public_url: {url}
components:
  r/talker: {{use: "restarted:Talker"}}
  r/listener: {{use: "restarted:Listener"}}
"""


def test_who_leaves_takes_nothing_along_that_was_lost(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    files = {"weather.py": WEATHER, "restarted.py": RESTARTED, "it.yaml": LAUNCH.format(url=ports.public_url)}
    write_files(tmp_path, files)
    for loss in ("0", "0.3"):
        run = launch("it.yaml", "--ticks", "60", "--record", f"{loss}.lcm", env={"FWK_TEST_LOSS": loss})
        assert run.wait() == 0, run.text
        assert "lost 0" in run.text
    assert len(Recording(tmp_path / "0.lcm").messages["r/imu"]) > 80
    assert difference(tmp_path / "0.lcm", tmp_path / "0.3.lcm") == ""
