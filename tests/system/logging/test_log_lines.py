"""Real processes that are targets of the log."""

import signal
from pathlib import Path

import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, fwk, replayed, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

PARTS = '''
"""Who worries, and who listens."""

from fwk import Clock, Component, Config, Logger, LogLines, Writes
from lcmtypes.robot import imu_t


class WorrierConfig(Config):
    lines: int = 1
    """Warnings in tick 5."""
    raises: bool = False
    """Whether that tick is its last."""


class Worrier(Component):
    stage = "think"
    clock: Clock
    config: WorrierConfig
    log: Logger

    def loop(self) -> None:
        self.log.debug("not from where it stands")
        if self.clock.tick == 5:
            for number in range(self.config.lines):
                self.log.warning(f"worry {number}")
            print("printed")
            if self.config.raises:
                raise RuntimeError("enough")


class Listener(Component):
    stage = "post_loop"
    lines: LogLines
    log: Logger
    heard: Writes[imu_t]

    def loop(self) -> None:
        for line in self.lines.of("warning"):
            self.heard.value.heading_rad += line.wall_us % 1000 / 1000 + len(line.text)
            self.log.warning(f"heard of {line.component}: {line.text}")
        self.heard.write()


class Free(Listener):
    stage = ()
    rate_hz = 0
'''
LAUNCH = """
public_url: {url}
log: {{console: debug}}
components:
  a/worrier: {{use: "parts:Worrier", config: {{lines: {lines}, raises: {raises}}}, restart: {{when: never}}}}
  a/listener: {{use: "parts:{listener}"}}
"""


def written(folder: Path, ports: PortBlock, listener: str = "Listener", lines: int = 1, raises: bool = False) -> None:
    text = LAUNCH.format(url=ports.public_url, listener=listener, lines=lines, raises=raises)
    write_files(folder, {"parts.py": PARTS, "alarm.yaml": text})


@pytest.mark.parametrize(
    ("listener", "hosting"), [("Listener", "process"), ("Listener", "single"), ("Free", "process")]
)
def test_a_component_hears_the_lines_of_others_and_is_replayed_with_them(
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


def test_more_lines_than_a_tick_takes_are_counted_and_said(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    written(tmp_path, ports, lines=150)
    run = launch("alarm.yaml", "--record", "log.lcm")
    run.until("lines did not reach the components that ask for lines: too many in one tick")
    Steered(run, ports).end()
    replayed(tmp_path)
