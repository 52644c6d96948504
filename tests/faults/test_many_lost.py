"""Thousands of messages are lost at once and their writer dies: a replay withholds them from the same reader."""

from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files

pytestmark = pytest.mark.system

MANY = 20_000
LAUNCH = """
name: talk
public_url: {url}
speed: max
components:
  r/talker: {{use: "talk:Talker", restart: {{backoff_s: 0.01}}}}
  r/listener: {{use: "talk:Listener"}}
"""


def test_many_lost_messages_are_lost_again_in_replay(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, {**sources("talk.py"), "talk.yaml": LAUNCH.format(url=ports.public_url)})
    run = launch("talk.yaml", "--ticks", "10", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    assert [pose.x_m for pose in Recording(tmp_path / "log.lcm").decoded("r/pose")] == [1.0] * 4 + [0.0] + [1.0] * 5
    assert f"{MANY} messages are missing in it" in run.text
    assert "equal: " in replayed(tmp_path)
