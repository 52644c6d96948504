"""No message is sent before a slow gateway has its sockets."""

from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.faults.conftest import RUN, WAITS, until_it_waits
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.runs import write_files

pytestmark = pytest.mark.system


@pytest.fixture
def slow(traced: Path) -> Path:
    """The orchestra's folder with a slow gateway."""
    write_files(traced, sources("slow_gateway.py"))
    player = traced / "player.py"
    text = player.read_text()
    assert "import weather " in text
    player.write_text(text.replace("import weather ", "import slow_gateway "))
    return traced


def trouble(kind: str) -> list[str]:
    """Settings of `a/player`."""
    settings = {"trouble": kind, "trouble_tick": 1, "trouble_stage": "act"}
    return [f"--set=a/player.{name}={value}" for name, value in settings.items()]


@pytest.mark.parametrize("hosting", ["process", "single"])
def test_a_slow_gateway_records_a_writer_that_died_in_tick_one(
    launch: Launch, slow: Path, after: Aftermath, hosting: str
) -> None:
    run = launch(*RUN, "--ticks", "40", "--hosting", hosting, *trouble("loop:raise"), *WAITS)
    until_it_waits(run)
    after.note(run)
    (slow / "go-on").touch()
    recording = after.check(run, tracebacks=True)
    assert recording.gaps() == {}
    assert "a/player#2" in {header.writer for header in recording.headers("a/note")}
    assert "lost 0" in run.text


def test_a_slow_gateway_reports_a_failure_in_init(launch: Launch, slow: Path) -> None:
    run = launch(*RUN, *trouble("init:raise"))
    assert run.wait() == 1
    assert "a/player: failed in init" in run.text
