"""Fixtures of the fault tests: the orchestra, a launcher that cleans up, and the log of an undisturbed run."""

from pathlib import Path

import pytest

from tests.faults.aftermath import Aftermath
from tests.harness.fixtures import folder, launch, orchestra_types
from tests.harness.runs import Launched, played
from tests.programs.orchestra import orchestra

__all__ = ["RUN", "TICKS", "WAITS", "folder", "launch", "orchestra_types", "until_it_waits"]

TICKS = 40
RUN = ("launch/orchestra.yaml", "--seed", "7", "--record", "log.lcm")
WAITS = ("--set", "d/player.trouble=loop:wait", "--set", "d/player.trouble_tick=5")
"""Options of a short run that must not end before its test has acted: `d/player` waits for the file `go-on`."""


def until_it_waits(run: Launched) -> None:
    """Waits until `d/player` does."""
    run.until_true((run.folder / "trouble-d_player").exists, "d/player waits")


@pytest.fixture(scope="session")
def undisturbed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The log of an undisturbed run in lockstep."""
    return played(tmp_path_factory.mktemp("undisturbed"), orchestra, *RUN, "--ticks", str(TICKS))


@pytest.fixture
def traced(folder: Path) -> Path:
    """The orchestra's folder, in which players write their process ids and ticks."""
    (folder / "traces").mkdir()
    return folder


@pytest.fixture
def wall(traced: Path) -> Path:
    """The orchestra in real time, without a conductor."""
    file = traced / "launch/orchestra.yaml"
    lines = [line for line in file.read_text().splitlines() if "conductor" not in line and "speed" not in line]
    file.write_text("\n".join([*lines, "clock: wall", "period_s: 0.05", "stage_time_s: 0.3", ""]))
    return traced


@pytest.fixture
def after() -> Aftermath:
    """Notes what runs hold of the machine; checks after the test that all of it was released."""
    return Aftermath()
