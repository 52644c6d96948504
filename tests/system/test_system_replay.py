"""Whatever happens in a run, real components fed with its recording do the same again, byte for byte."""

import os
import random
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from lcmtypes.core import tick_event_t
from tests.system.command_system import command_system
from tests.system.conftest import Launch
from tests.system.control_system import Steered
from tests.system.system_logs import Recording
from tests.system.system_orchestra import GROUPS, PLAYER, PLAYERS, orchestra
from tests.system.system_runs import BIN, TIMEOUT_S, PortBlock, write_files
from tests.system.system_terminals import Terminal

pytestmark = pytest.mark.system

DRIVER = '''
"""Takes the main loop over and gives it back, again and again, and starts another component anew."""

from fwk import Clock, Component, MainLoop, PluginControl

ORDER = ["pre_loop", "sensor_acquire", "think", "sensor_prepare", "worldstate", "think", "act", "act", "post_loop"]


class Driver(Component):
    """Has the main loop for eight ticks of twenty-four."""

    stage = "think"
    clock: Clock
    main_loop: MainLoop
    plugins: PluginControl

    def loop(self) -> None:
        if self.clock.tick % 24 == 4:
            self.plugins.restart("d/player")
        if self.clock.tick % 24 == 8:
            self.main_loop.take_over(ORDER)
        if self.clock.tick % 24 == 16:
            self.main_loop.give_back()
'''
TOGETHER = """
name: together
include: [orchestra.yaml, lift.yaml]
components:
  z/driver: {use: "driver:Driver"}
"""
WALL = """
clock: wall
period_s: 0.05
stage_time_s: 0.03
"""


@pytest.fixture(params=["lockstep", "groups", "real time", "real time, groups"])
def together(request: pytest.FixtureRequest, tmp_path: Path, ports: PortBlock) -> Path:
    """Orchestra and lift in one run, by either clock, each component alone or some in groups."""
    files = orchestra(ports.public_url, GROUPS if "groups" in request.param else "") | command_system(ports.public_url)
    files |= {"driver.py": DRIVER, "launch/together.yaml": TOGETHER}
    for name in ("launch/orchestra.yaml", "launch/lift.yaml"):
        files[name] = re.sub(r'use: ("[\w.:]+")', r"use: \1, restart: {limit: 100, backoff_s: 0.01}", files[name])
        if "real" in request.param:
            files[name] = re.sub(
                r"  world/conductor: .*\n|, world/conductor|  a/viewer: .*\n|speed: max\n", "", files[name]
            )
    if "real" in request.param:
        files["launch/together.yaml"] += WALL
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


def trouble(run: Steered, luck: random.Random) -> None:
    """Something that people or fate do to a run."""
    what = luck.choice(["kill", "kill", "stop and start", "restart", "set", "pause"])
    components = run.ask("status")["components"]
    one = luck.choice(components)
    everybody = [each["name"] for each in components if each["process"] == one["process"]]
    if what == "kill" and one["pid"]:
        os.kill(one["pid"], signal.SIGKILL)
    elif what == "stop and start":
        run.steer("stop", *everybody)
        run.ticks_pass(luck.randrange(1, 4))
        run.steer("start", *everybody)
    elif what == "restart":
        run.steer("restart", *everybody)
    elif what == "set":
        name = f"{luck.choice(PLAYERS)}/player"
        run.ask("set", changes=[f"{name}.bursts={luck.randrange(6)}", f"{name}.ballast={luck.randrange(100)}"])
    elif one["pid"]:
        os.kill(one["pid"], signal.SIGSTOP)
        if run.ask("run")["clock"] == "wall":
            run.ticks_pass(luck.randrange(1, 4))
        os.kill(one["pid"], signal.SIGCONT)


def test_what_people_and_fate_did_to_a_run_is_replayed_exactly(
    together: Path, ports: PortBlock, launch: Launch
) -> None:
    run = Steered(launch("launch/together.yaml", "--record", "log.lcm"), ports)
    real_time = run.ask("run")["clock"] == "wall"
    luck = random.Random(3)
    for _ in range(30):
        trouble(run, luck)
        run.ticks_pass(luck.randrange(1, 5))
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    recording = Recording(together / "log.lcm")
    kinds = {event.kind for record in recording.records for event in record.events}
    assert {tick_event_t.LOST, tick_event_t.STOPPED, tick_event_t.MAIN_LOOP} <= kinds
    assert (tick_event_t.LATE in kinds) == real_time
    assert any(record.n_changes for record in recording.records)
    assert recording.messages["r/lift@one/worker"]
    assert "equal" in replayed(together)
    assert "equal" in replayed(together, "--only", "c/player", "--only", "r/lifter")


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
            "there in the recording, missing in the replay",
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


def test_a_replay_stops_in_the_debugger_at_a_tick_and_goes_on_exactly(recorded: Path) -> None:
    command = [sys.executable, "-m", "fwk.cli.main", "replay", "log.lcm", "--debug", "e/player", "--from-tick", "12"]
    stopped = Terminal(recorded, *command, "--verify")
    assert "loop()" in stopped.prompt()
    assert "('e/player', 12)" in stopped.ask("p (self.name, self.clock.tick)")
    stopped.ask(f"tbreak {recorded / 'procs/player.py'}:{line_of('self.note.write()')}")
    stopped.ask("c")
    assert "12" in stopped.ask("p note.iterations")
    stopped.type("c")
    stopped.child.expect("equal: ")
    assert stopped.end() == 0
    left = Terminal(recorded, *command)
    left.prompt()
    left.type("q")
    left.child.expect("left in tick 12")
    assert left.end() == 0


def test_a_component_that_fails_in_a_replay_can_be_looked_at(recorded: Path) -> None:
    file = recorded / "procs/player.py"
    file.write_text(file.read_text().replace("        self.note.write()", "        1 / (self.clock.tick - 20)"))
    command = [sys.executable, "-m", "fwk.cli.main", "replay", "log.lcm", "--debug", "e/player", "--from-tick", "19"]
    failed = Terminal(recorded, *command)
    failed.prompt()
    assert "ZeroDivisionError" in failed.ask("c")
    assert "20" in failed.ask("p note.iterations")
    failed.type("q")
    assert failed.end() == 0


def line_of(text: str) -> int:
    """Where it stands in the player's file."""
    return 1 + next(number for number, line in enumerate(PLAYER.splitlines()) if text in line)


@pytest.mark.parametrize("tick", [1, 9])
@pytest.mark.parametrize("what", ["kill after publish", "raise"])
@pytest.mark.parametrize("hosting", ["process", "single"])
def test_who_dies_in_an_iteration_is_replayed_from_its_new_start_on(
    folder: Path, launch: Launch, what: str, tick: int, hosting: str
) -> None:
    settings = {"trouble": f"loop:{what}", "trouble_tick": tick, "trouble_stage": "act"}
    sets = [f"--set=a/player.{key}={value}" for key, value in settings.items()]
    run = launch("launch/orchestra.yaml", "--record", "log.lcm", "--ticks", "20", "--hosting", hosting, *sets)
    assert run.wait() == 0, run.text
    assert "a/player#2" in {header.writer for header in Recording(folder / "log.lcm").headers("a/note")}
    assert "equal: " in replayed(folder)
