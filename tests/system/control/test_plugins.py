"""A component starts and stops others between two ticks, in the same ticks each time, and the recording replays."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.logs import Recording, difference
from tests.harness.runs import Launched, PortBlock, replayed, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: directed
speed: max
public_url: {url}
components:
  b/rival: {{use: "directors:Rival"}}
  r/counter: {{use: "small:Counter"}}
  r/follower: {{use: "small:Follower"}}
  r/camera: {{use: "small:Camera", start: false}}
  r/finder: {{use: "small:Finder", start: false}}
  a/director: {{use: "directors:Director"}}
"""


def test_plugin_requests_take_effect_at_the_same_ticks(
    tmp_path: Path, ports: PortBlock, launch: Callable[..., Launched]
) -> None:
    write_files(tmp_path, {**sources("small.py", "directors.py"), "it.yaml": LAUNCH.format(url=ports.public_url)})
    logs = [tmp_path / "one.lcm", tmp_path / "two.lcm"]
    for log in logs:
        run = launch("it.yaml", "--ticks", "20", "--record", str(log))
        assert run.wait() == 0, run.text
        assert "a/director asked to stop r/counter" in run.text
        assert "a/director wants to unload r/camera; refused: r/camera is needed by r/finder" in run.text
    assert difference(*logs) == ""
    recording = Recording(logs[0])
    ticks = {channel: [header.tick for header in recording.headers(channel)] for channel in recording.messages}
    assert ticks["r/imu"] == [1, 2, 3, 4, 5, 6, 7, *range(11, 21)]  # restarted after 5, stopped after 7
    assert ticks["r/image"] == ticks["r/seen"] == list(range(9, 21))
    assert ticks["r/pose"] == list(range(1, 21))
    writers = [header.writer for header in recording.headers("r/imu")]
    assert list(dict.fromkeys(writers)) == ["r/counter", "r/counter#2", "r/counter#3", "r/counter#4"]
    replayed(tmp_path, log=logs[0])
