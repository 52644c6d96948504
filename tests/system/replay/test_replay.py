"""Real components fed with the recording of any run write the same messages, byte for byte."""

import json
import random
import re
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from fwk.model.tick_events import HostLate, HostLost, HostStopped, MainLoopGiven
from tests.harness.components import source, sources
from tests.harness.fate import Fate
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import UNHURRIED, PortBlock, fwk, played, replayed, write_files
from tests.harness.terminals import Terminal
from tests.programs.control_system import Steered
from tests.programs.orchestra import orchestra
from tests.programs.together import FILE, together

pytestmark = pytest.mark.system


@pytest.mark.parametrize(
    ("real_time", "groups"), [(False, True), (True, False)], ids=["lockstep-groups", "real time-alone"]
)
def test_requests_and_crashes_are_replayed_exactly(
    tmp_path: Path, ports: PortBlock, launch: Launch, real_time: bool, groups: bool
) -> None:
    write_files(tmp_path, together(ports.public_url, real_time=real_time, groups=groups))
    (tmp_path / "traces").mkdir()
    run = Steered(launch(FILE, "--record", "log.lcm", *(() if real_time else UNHURRIED)), ports)
    luck = random.Random(3)
    fate = Fate(run, ports, luck)
    for _ in range(20):
        fate.strike(luck.choice(["kill", "kill", "stop and start", "restart", "set", "still"]))
        run.ticks_pass(luck.randrange(1, 5))
    run.launched.signal(signal.SIGINT)
    assert run.launched.wait() == 0, run.launched.text
    recording = Recording(tmp_path / "log.lcm")
    kinds = {type(event) for _, event in recording.events}
    assert {HostLost, HostStopped, MainLoopGiven} <= kinds
    assert (HostLate in kinds) == real_time
    assert any(record.settings for record in recording.records)
    assert recording.messages["r/lift@one/worker"]
    replayed(tmp_path)
    replayed(tmp_path, "--only", "c/player", "--only", "r/lifter")


@pytest.fixture(scope="module")
def original(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the recording of 30 ticks of the orchestra."""
    folder = tmp_path_factory.mktemp("orchestra")
    played(folder, orchestra, "launch/orchestra.yaml", "--record", "log.lcm", "--ticks", "30")
    return folder


@pytest.fixture
def recorded(original: Path) -> Iterator[Path]:
    """The folder of the original run; a change of the players is undone after the test."""
    yield original
    write_files(original, sources("player.py"))


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
def test_replay_names_the_first_difference_of_a_changed_class(
    recorded: Path, before: str, after: str, what: str
) -> None:
    file = recorded / "player.py"
    changed = "(self.name == 'd/player' and self.clock.tick >= 17)"
    assert before in file.read_text()
    file.write_text(file.read_text().replace(before, after.replace("CHANGED", changed)))
    said = replayed(recorded, code=1)
    assert re.search(r"d/player: d/note: tick 17, stage 5, message 17 by d/player: " + re.escape(what), said), said
    assert "different: 14 of " in said
    replayed(recorded, "--to-tick", "16")
    replayed(recorded, "--only", "c/player", "--only", "e/player")
    assert "different: 4 of " in replayed(recorded, "--only", "d/*", "--from-tick", "27", code=1)


def test_replay_of_nothing_is_refused(recorded: Path) -> None:
    said = replayed(recorded, "--only", "d", "--from-tick", "31", code=2)
    assert "log.lcm: nothing was compared: no tick 31; the last one is 30" in said
    assert "no component 'd/plaier' in this run; did you mean 'd/player'?" in replayed(
        recorded, "--only", "d/plaier", code=2
    )
    assert "equal: " in replayed(recorded, "--only", "d", "--from-tick", "30")


def test_verify_names_every_component_that_differs(recorded: Path) -> None:
    file = recorded / "player.py"
    since = "{'d': 9, 'c': 12}.get(self.name[0], 99)"
    changed = f"        note.iterations += time.time() > 0 and self.clock.tick >= {since}\n"
    text = file.read_text().replace("        self.note.write()", f"{changed}        self.note.write()", 1)
    file.write_text(text.replace("import os\n", "import os\nimport time\n", 1))
    said = replayed(recorded, code=1)
    assert (
        "2 components differ, in this order:\n  d/player: d/note, from tick 9 on\n  c/player: c/note, from tick 12 on"
        in said
    )
    causes = said.partition("d/player may differ from run to run:\n")[2].partition("c/player may")[0]
    assert re.search(r"^  \S+player.py:\d+: reads the machine's clock$", causes, re.MULTILINE), said
    answer, _ = json.JSONDecoder().raw_decode(fwk(recorded, "replay", "log.lcm", "--verify", "--json", code=1))
    rows = [(row["component"], row["first"]["tick"], row["differences"]) for row in answer["components"]]
    assert rows == [("d/player", 9, 22), ("c/player", 12, 19)]


def test_a_replay_stops_in_the_debugger_and_goes_on_exactly(recorded: Path) -> None:
    command = ["fwk", "replay", "log.lcm", "--debug", "e/player", "--from-tick", "12"]
    stopped = Terminal(recorded, *command, "--verify")
    assert "loop()" in stopped.prompt()
    assert "('e/player', 12)" in stopped.ask("p (self.name, self.clock.tick)")
    stopped.ask(f"tbreak {recorded / 'player.py'}:{line_of('self.note.write()')}")
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


def test_a_component_that_fails_in_replay_can_be_debugged(recorded: Path) -> None:
    file = recorded / "player.py"
    file.write_text(file.read_text().replace("        self.note.write()", "        1 / (self.clock.tick - 20)"))
    command = ["fwk", "replay", "log.lcm", "--debug", "e/player", "--from-tick", "19"]
    failed = Terminal(recorded, *command)
    failed.prompt()
    assert "ZeroDivisionError" in failed.ask("c")
    assert "20" in failed.ask("p note.iterations")
    failed.type("q")
    assert failed.end() == 0


def line_of(text: str) -> int:
    """Returns the line of a text in the player's file."""
    return 1 + next(number for number, line in enumerate(source("player.py").splitlines()) if text in line)


@pytest.mark.parametrize(
    ("what", "tick", "hosting"),  # each pair of values
    [
        ("kill after publish", 1, "process"),
        ("kill after publish", 9, "single"),
        ("raise", 1, "single"),
        ("raise", 9, "process"),
    ],
)
def test_a_death_in_an_iteration_is_replayed_from_the_restart(
    folder: Path, launch: Launch, what: str, tick: int, hosting: str
) -> None:
    settings = {"trouble": f"loop:{what}", "trouble_tick": tick, "trouble_stage": "act"}
    sets = [f"--set=a/player.{key}={value}" for key, value in settings.items()]
    run = launch("launch/orchestra.yaml", "--record", "log.lcm", "--ticks", "20", "--hosting", hosting, *sets)
    assert run.wait() == 0, run.text
    assert "a/player#2" in {header.writer for header in Recording(folder / "log.lcm").headers("a/note")}
    replayed(folder)
