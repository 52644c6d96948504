"""Real processes that are targets of the log."""

import signal
from pathlib import Path

import pytest

from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, fwk, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = """
public_url: {url}
log: {{console: debug}}
components:
  a/worrier: {{use: "alarm:Worrier", config: {{lines: {lines}, raises: {raises}}}, restart: {{when: never}}}}
  a/listener: {{use: "alarm:{listener}"}}
"""


def written(folder: Path, ports: PortBlock, listener: str = "Listener", lines: int = 1, raises: bool = False) -> None:
    text = LAUNCH.format(url=ports.public_url, listener=listener, lines=lines, raises=raises)
    write_files(folder, {**sources("alarm.py"), "alarm.yaml": text})


@pytest.mark.parametrize(
    ("listener", "hosting"), [("Listener", "process"), ("Listener", "single"), ("Free", "process")]
)
def test_a_reader_of_log_lines_hears_others_and_replays(
    tmp_path: Path, ports: PortBlock, launch: Launch, listener: str, hosting: str
) -> None:
    alone = hosting == "process"
    written(tmp_path, ports, listener, raises=alone)
    assert "fwk/lines  core.log_t" in fwk(tmp_path, "check", "alarm.yaml", "--channels")
    run = launch("alarm.yaml", "--record", "log.lcm", "--hosting", hosting)
    run.until("heard of a/worrier: worry 0")
    if alone:
        run.until("heard of a/worrier: failed in loop, tick 5")
        run.until("heard of supervisor: a/worrier ended: RuntimeError: enough")
    steered = Steered(run, ports)
    assert "gateway" in steered.fwk("bb", "list", "fwk/lines")
    steered.ticks_pass(2)
    run.signal(signal.SIGINT)
    assert run.wait() == int(alone), run.text  # a component has failed
    recording = Recording(tmp_path / "log.lcm")
    assert max(message.heading_rad for message in recording.decoded("a/heard")) > 0.0
    assert "heard of a/listener" not in run.text
    replayed(tmp_path)
    replayed(tmp_path, "--only", "a/listener")


def test_log_lines_beyond_the_limit_of_a_tick_are_counted(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    written(tmp_path, ports, lines=150)
    run = launch("alarm.yaml", "--record", "log.lcm")
    run.until("lines did not reach the components with LogLines: too many in one tick")
    Steered(run, ports).end()
    replayed(tmp_path)
