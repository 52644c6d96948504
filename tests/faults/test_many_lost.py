"""Thousands of messages get lost at once, and their writer with them: a replay keeps each from who never got it."""

from pathlib import Path

import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files

pytestmark = pytest.mark.system

MANY = 20_000
PARTS = f'''
"""A talker whose messages get lost before it dies, and who listens to it."""

import os
import signal
from pathlib import Path

from fwk import Clock, Component, Reads, Writes
from fwk.host.outputs import Outputs
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


def lose_and_die() -> None:
    publish = Outputs.publish

    def publish_nothing(self, written):
        send = self._sender.publish

        def send_last(*done):
            send(*done)
            os.kill(os.getpid(), signal.SIGKILL)

        self._sender.publish = lambda *_: None
        marks = publish(self, written)
        self._sender.publish = send_last
        return marks

    Outputs.publish = publish_nothing


class Talker(Component):
    """Says much, once."""

    stage = "sensor_acquire"
    clock: Clock
    imu: Writes[imu_t]

    def loop(self) -> None:
        much = self.clock.tick == 5
        for _ in range({MANY} if much else 1):
            self.imu.value.heading_rad += 1.0
            self.imu.write()
        if much and not Path("died").exists():
            Path("died").touch()
            lose_and_die()


class Listener(Component):
    """Counts what it hears."""

    stage = "think"
    imu: Reads[imu_t]
    pose: Writes[pose_t]

    def loop(self) -> None:
        self.pose.value.x_m = float(len(self.imu.fresh))
        self.pose.value.y_m += sum(each.heading_rad for each in self.imu.fresh)
        self.pose.write()
'''
LAUNCH = """
name: talk
public_url: {url}
speed: max
components:
  r/talker: {{use: "talk:Talker", restart: {{backoff_s: 0.01}}}}
  r/listener: {{use: "talk:Listener"}}
"""


def test_what_was_lost_is_kept_from_its_reader_again_however_much(
    launch: Launch, tmp_path: Path, ports: PortBlock
) -> None:
    write_files(tmp_path, {"talk.py": PARTS, "talk.yaml": LAUNCH.format(url=ports.public_url)})
    run = launch("talk.yaml", "--ticks", "10", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    assert [pose.x_m for pose in Recording(tmp_path / "log.lcm").decoded("r/pose")] == [1.0] * 4 + [0.0] + [1.0] * 5
    assert f"{MANY} messages were lost on their way there" in run.text
    assert "equal: " in replayed(tmp_path)
