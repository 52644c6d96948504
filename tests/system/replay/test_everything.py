"""A run with every kind of event is replayed exactly, and a changed component is found."""

import json
import random
import re
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.lcm.type_registry import use_types_of
from fwk.model.tick_events import HostLate, HostLost, HostStopped, MainLoopGiven, TickTold
from tests.harness.fate import Fate
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import TIMEOUT_S, UNHURRIED, PortBlock, replayed, write_files
from tests.programs.control_system import Steered
from tests.programs.everything import everything
from tests.programs.together import FILE

pytestmark = pytest.mark.system

STRIKES = (
    ("call", ""),
    ("wish", ""),
    ("set", "e/player"),
    ("kill", "e/player"),
    ("set", "z/follower"),
    ("still", "f/player"),
    ("stop and start", "r/lifter"),
    ("call", ""),
    ("kill", "z/planner"),
    ("set", "z/planner"),
    ("restart", "z/follower"),
    ("kill", "z/driver"),
    ("wish", ""),
    ("kill", "one/worker"),
    ("set", "d/player"),
)


def each_alone(folder: Path) -> dict[str, tuple[int, list[str]]]:
    """Returns for each component how many messages were compared, and which differed."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.harness.each_alone"],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=TIMEOUT_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, tuple[int, list[str]]] = json.loads(done.stdout)
    return found


@pytest.mark.parametrize("clock", ["lockstep", "real time"])
def test_a_run_with_every_kind_of_event_is_replayed_exactly(
    launch: Launch, tmp_path: Path, ports: PortBlock, clock: str
) -> None:
    write_files(tmp_path, everything(ports.public_url, real_time=clock == "real time"))
    use_types_of(tmp_path)
    run = Steered(launch(FILE, "--record", "log.lcm", *(UNHURRIED if clock == "lockstep" else ())), ports)
    fate = Fate(run, ports, random.Random(2))
    for what, whom in STRIKES:
        fate.strike(what, whom)
        run.ticks_pass(2)
    run.ticks_pass(24)
    run.end()
    kinds = {type(event) for _, event in Recording(tmp_path / "log.lcm").events}
    usual = {HostLost, HostStopped, MainLoopGiven, TickTold}
    assert usual <= kinds
    assert (HostLate in kinds) == (clock == "real time")
    replayed(tmp_path)
    alone = each_alone(tmp_path)
    assert {name: differences for name, (_, differences) in alone.items() if differences} == {}
    assert min(compared for name, (compared, _) in alone.items() if name not in ("world/conductor", "z/driver")) > 0
    parts = tmp_path / "everything_parts.py"
    parts.write_text(parts.read_text().replace("self.digest + float(", "(self.digest + 1.0) + float("))
    said = replayed(tmp_path, "--only", "z/planner", code=1)
    assert re.search(r"z/planner: z/plan: tick \d+, stage \d+, message \d+ by z/planner: heading_rad is ", said), said
