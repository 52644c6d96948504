"""Programs with LCM's default settings hear a run that makes hundreds of messages visible at once."""

from pathlib import Path

import pytest

from fwk.lcm.event_log import LogReader
from tests.clients.bus import Bus
from tests.harness.runs import Launched, PortBlock, write_files

pytestmark = pytest.mark.system

PARTS = '''
"""Writes many messages in each tick."""

from fwk import Component, Writes
from lcmtypes.core import acknowledgement_t


class Burst(Component):
    stage = "think"
    note: Writes[acknowledgement_t]

    def loop(self) -> None:
        for _ in range(200):
            self.note.write()
'''
LAUNCH = """
name: burst
period_s: 0.05
public_url: {url}
components:
  a/burst: {{use: "burst:Burst"}}
"""
TICKS = 60
HEARD = 0.8
"""Share that has to be heard on a machine that is busy with other tests; without pacing it is half."""


def test_lcm_logger_hears_bursts_of_two_hundred_messages(tmp_path: Path, ports: PortBlock) -> None:
    bus = Bus(ports.public_url.replace("&recv_buf_size=4194304", ""))
    write_files(tmp_path, {"burst.py": PARTS, "burst.yaml": LAUNCH.format(url=ports.public_url)})
    with bus.logger(tmp_path / "heard"):
        run = Launched(tmp_path, ports, ("burst.yaml", "--ticks", str(TICKS), "--record", "log.lcm"), {})
        try:
            assert run.wait() == 0, run.text
        finally:
            run.end()
    recorded, heard = (_notes(tmp_path / name) for name in ("log.lcm", "heard"))
    assert len(recorded) == 200 * TICKS
    assert len(heard) > HEARD * len(recorded)
    assert set(heard) <= set(recorded)


def _notes(log: Path) -> list[bytes]:
    return [event.data for event in LogReader(log) if event.channel == "a/note"]
