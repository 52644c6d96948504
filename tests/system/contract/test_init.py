"""Messages written in `init` are like all others: visible, stamped, recorded and replayed."""

from pathlib import Path

import pytest

from fwk.recording.compare import Comparison
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, replayed, write_files

pytestmark = pytest.mark.system

LAUNCH = """
name: early
public_url: {url}
components:
  r/speaker: {{use: "early:Speaker", restart: {{backoff_s: 0.01}}}}
  r/listener: {{use: "early:Listener"}}
"""


def test_messages_of_init_are_sent_with_the_first_iteration(launch: Launch, tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, {**sources("early.py"), "it.yaml": LAUNCH.format(url=ports.public_url)})
    run = launch("it.yaml", "--ticks", "20", "--speed", "max", "--record", "it.lcm")
    run.wait()
    recording = Recording(tmp_path / "it.lcm")
    said = [(header.tick, header.stage, header.sequence, header.writer) for header in recording.headers("r/pose")]
    first, again = "r/speaker", "r/speaker#2"
    assert said == [
        *((1, 5, sequence, first) for sequence in (1, 2, 3)),
        (6, 5, 4, first),
        *((8, 5, sequence, again) for sequence in (5, 6)),
        *((tick, 5, sequence, again) for tick, sequence in ((11, 7), (16, 8))),
    ]
    assert [header.tick for header in recording.headers("r/heard")] == [1, 1, 1, 1, 6, 8, 8, 11, 16]
    replayed(tmp_path, log="it.lcm")
    launch("it.yaml", "--ticks", "6", "--speed", "max", "--record", "six.lcm").wait()
    launch("it.yaml", "--ticks", "6", "--speed", "max", "--record", "single.lcm", "--hosting", "single").wait()
    assert Comparison(tmp_path / "six.lcm", tmp_path / "single.lcm", False).difference is None
