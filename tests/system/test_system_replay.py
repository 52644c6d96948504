"""Whatever happens in a run, real components fed with its recording do the same again, byte for byte."""

import os
import random
import re
import signal
import subprocess
from pathlib import Path

import pytest

from lcmtypes.core import tick_event_t
from tests.system.conftest import Launch
from tests.system.control_system import Steered
from tests.system.system_logs import Recording
from tests.system.system_orchestra import GROUPS, PLAYERS, orchestra
from tests.system.system_runs import BIN, TIMEOUT_S, PortBlock, write_files

pytestmark = pytest.mark.system

WALL = """
clock: wall
period_s: 0.05
stage_time_s: 0.03
"""


@pytest.fixture(params=["lockstep", "groups", "real time", "real time, groups"])
def orchestra_folder(request: pytest.FixtureRequest, tmp_path: Path, ports: PortBlock) -> Path:
    """The orchestra by either clock, each player alone or in groups; players leave traces."""
    files = orchestra(ports.public_url, GROUPS if "groups" in request.param else "")
    if "real" in request.param:
        text = files["launch/orchestra.yaml"].replace("speed: max", WALL)
        files["launch/orchestra.yaml"] = text.replace('  world/conductor: { use: "procs.player:Conductor" }\n', "")
        files["launch/orchestra.yaml"] = files["launch/orchestra.yaml"].replace(", world/conductor", "")
    write_files(tmp_path, files)
    (tmp_path / "traces").mkdir()
    return tmp_path


def replayed(folder: Path, *arguments: str, code: int = 0) -> str:
    """What `fwk replay log.lcm --verify` prints."""
    done = subprocess.run(
        [str(BIN / "fwk"), "replay", "log.lcm", "--verify", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=2 * TIMEOUT_S,
        check=False,
    )
    assert done.returncode == code, done
    return done.stdout


def events(recording: Recording, kind: int) -> int:
    return sum(event.kind == kind for record in recording.records for event in record.events)


def trouble(run: Steered, luck: random.Random) -> None:
    """Something that people or fate do to a run."""
    player = luck.choice(PLAYERS)
    name = f"{player}/player"
    what = luck.choice(["kill", "kill", "stop and start", "restart", "set", "pause"])
    process = next(each for each in run.ask("status")["components"] if each["name"] == name)
    everybody = [each["name"] for each in run.ask("status")["components"] if each["process"] == process["process"]]
    if what == "kill" and process["pid"]:
        os.kill(process["pid"], signal.SIGKILL)
    elif what == "stop and start":
        run.steer("stop", *everybody)
        run.ticks_pass(luck.randrange(1, 4))
        run.steer("start", *everybody)
    elif what == "restart":
        run.steer("restart", *everybody)
    elif what == "set":
        run.ask("set", changes=[f"{name}.bursts={luck.randrange(6)}", f"{name}.ballast={luck.randrange(100)}"])
    elif process["pid"]:
        os.kill(process["pid"], signal.SIGSTOP)
        if run.ask("run")["clock"] == "wall":
            run.ticks_pass(luck.randrange(1, 4))
        os.kill(process["pid"], signal.SIGCONT)


def test_what_people_and_fate_did_to_a_run_is_replayed_exactly(
    orchestra_folder: Path, ports: PortBlock, launch: Launch
) -> None:
    file = orchestra_folder / "launch/orchestra.yaml"
    restarts = "restart: {limit: 100, backoff_s: 0.01}"
    file.write_text(re.sub(r'use: ("[\w.:]+")', rf"use: \1, {restarts}", file.read_text()))
    run = Steered(launch("launch/orchestra.yaml", "--record", "log.lcm"), ports)
    luck = random.Random(3)
    run_is_real_time = run.ask("run")["clock"] == "wall"
    for _ in range(30):
        trouble(run, luck)
        run.ticks_pass(luck.randrange(1, 5))
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    recording = Recording(orchestra_folder / "log.lcm")
    if run_is_real_time:
        assert events(recording, tick_event_t.LATE)
    assert events(recording, tick_event_t.LOST)
    assert events(recording, tick_event_t.STOPPED)
    assert any(record.n_changes for record in recording.records)
    assert "equal" in replayed(orchestra_folder)
    assert "equal" in replayed(orchestra_folder, "--only", "c/player", "--only", "a/viewer")


@pytest.fixture
def recorded(folder: Path, launch: Launch) -> Path:
    """A folder with the recording of 30 ticks of the orchestra."""
    run = launch("launch/orchestra.yaml", "--record", "log.lcm", "--ticks", "30")
    assert run.wait() == 0, run.text
    return folder


@pytest.mark.parametrize(
    ("before", "after", "what"),
    [
        pytest.param(
            "made.newest_stage = reader.header.tick,",
            "made.newest_stage = reader.header.tick + CHANGED * (reader.channel == 'b/note'),",
            "heard[1].newest_tick is 17 in the recording, 18 in the replay",
            id="a member of a struct in an array",
        ),
        pytest.param(
            "note.heard = [",
            "note.heard = [] if CHANGED else [",
            "n is 12 in the recording, 0 in the replay",
            id="a shorter array",
        ),
        pytest.param(
            "        self.note.write()",
            "        CHANGED or self.note.write()",
            "missing in the replay",
            id="no message",
        ),
    ],
)
def test_a_changed_component_is_found_and_its_first_difference_named(
    recorded: Path, before: str, after: str, what: str
) -> None:
    file = recorded / "procs/player.py"
    changed = "(self.name == 'd/player' and self.clock.tick >= 17)"
    assert before in file.read_text()
    file.write_text(file.read_text().replace(before, after.replace("CHANGED", changed)))
    said = replayed(recorded, code=1)
    assert re.search(r"d/player: d/note: tick 17, stage 5, message 17 by d/player: " + re.escape(what), said), said
    assert "different: 14 of " in said
    assert "equal: " in replayed(recorded, "--to-tick", "16")
    assert "equal: " in replayed(recorded, "--only", "c/player", "--only", "e/player")
    assert "different: 4 of " in replayed(recorded, "--only", "d/*", "--from-tick", "27", code=1)
