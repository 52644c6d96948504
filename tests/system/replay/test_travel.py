"""Time travel in a replay under pdb: back, goto, until, and back until, with exactly the inputs of the run."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.clock import monotonic_us
from tests.harness.runs import fwk, played
from tests.harness.terminals import Terminal
from tests.programs.orchestra import orchestra

pytestmark = pytest.mark.system

BUSY = "any(now() > end for now in [__import__('time').process_time] for end in [now() + 0.2] for _ in iter(int, 1))"
"""True, after a fifth of a second of computing."""


@pytest.fixture(scope="module")
def recorded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the recording of 40 ticks of the orchestra."""
    folder = tmp_path_factory.mktemp("orchestra")
    options = ("--ticks", "40", "--speed", "max", "--record", "log.lcm")
    played(folder, orchestra, "launch/orchestra.yaml", *options)
    return folder


def debugged(folder: Path, name: str, *words: str) -> Terminal:
    """A replay under pdb, at its first prompt."""
    terminal = Terminal(folder, "fwk", "replay", "log.lcm", "--debug", name, *words)
    assert "loop()" in terminal.prompt()
    return terminal


def where(terminal: Terminal) -> tuple[int, int]:
    """Returns the tick, and the iterations before, of the stopped component."""
    found = re.search(r"\((\d+), (\d+)\)", terminal.ask("p (self.clock.tick, self.note.value.iterations)"))
    assert found
    return int(found[1]), int(found[2])


def test_the_debugger_goes_back_and_forward_in_time(recorded: Path) -> None:
    stopped = debugged(recorded, "e/player", "--from-tick", "20", "--verify")
    assert where(stopped) == (20, 19)
    heard = stopped.ask("p self.digest()")
    for command, tick in (
        ("back", 19),
        ("back 5", 14),
        ("goto 30", 30),
        ("goto 8", 8),
        ("until self.note.value.iterations == 25", 26),
        ("back until self.clock.tick % 10 == 0", 20),
    ):
        assert f"fwk: tick {tick}\r\n" in stopped.ask(command), command
        assert where(stopped) == (tick, tick - 1), command
    assert stopped.ask("p self.digest()") == heard
    stopped.ask("n")
    stopped.ask("back")
    assert where(stopped) == (19, 18)
    for command, what in (("until self.clock.tick > 999", "where self.clock.tick > 999"), ("goto 999", "in tick 999")):
        assert f"fwk: the recording ends without an iteration {what}" in stopped.ask(command)
        assert where(stopped) == (19, 18), "a travel that fails leads back"
    stopped.type("c")
    stopped.child.expect("equal: ")
    assert stopped.end() == 0


def test_a_long_travel_says_where_it_is(recorded: Path) -> None:
    stopped = debugged(recorded, "e/player", "--from-tick", "3")
    said = stopped.ask(f"until self.clock.tick == 20 or not {BUSY}")
    assert re.search(r"replaying tick \d+", said)
    assert "fwk: tick 20\r\n" in said
    stopped.type("q")
    assert stopped.end() == 0


def test_impossible_travels_are_explained(recorded: Path) -> None:
    stopped = debugged(recorded, "e/player", "--from-tick", "3")
    for command, reason in (
        ("back 3", "there are 2 iterations before this one"),
        ("back soon", "back takes a number of iterations, or 'until CONDITION'"),
        ("goto x", "goto takes a tick: goto 1200"),
        ("until self.nota > 1", "AttributeError: 'Player' object has no attribute 'nota'"),
        ("back until 1 +", "SyntaxError: invalid syntax"),
    ):
        assert reason in stopped.ask(command), command
        assert where(stopped) == (3, 2)
    assert "no earlier iteration where self.clock.tick > 9" in stopped.ask("back until self.clock.tick > 9")
    assert where(stopped) == (3, 2)
    stopped.type("q")
    stopped.child.expect("left in tick 3")
    assert stopped.end() == 0


def test_a_replay_that_ends_before_its_first_stop_says_so(recorded: Path) -> None:
    said = fwk(recorded, "replay", "log.lcm", "--debug", "e/player", "--from-tick", "99")
    assert "fwk: the recording ends without an iteration in tick 99 or after it" in said


def test_breakpoints_survive_a_travel(recorded: Path) -> None:
    stopped = debugged(recorded, "a/player", "--from-tick", "10")  # takes part in two stages of a tick
    line = 1 + (recorded / "player.py").read_text().splitlines().index("        self.note.write()")
    stopped.ask(f"break player.py:{line}, self.clock.tick == 8")
    stopped.ask("back 10")
    assert where(stopped) == (5, 8)
    assert "self.note.write()" in stopped.ask("c")
    assert where(stopped) == (8, 15)
    stopped.ask("clear 1")
    assert "ok" in stopped.ask("p 'ok'")
    stopped.type("c")
    stopped.child.expect("iterations replayed")
    assert stopped.end() == 0


def test_frames_of_the_past_come_back(recorded: Path) -> None:
    stopped = debugged(recorded, "a/viewer", "--from-tick", "30", "--verify")
    for command in ("goto 5", "goto 20", "back 3"):
        stopped.ask(command)
    stopped.type("c")
    stopped.child.expect("equal: ")
    assert stopped.end() == 0


def test_an_iteration_back_takes_less_than_a_second(recorded: Path) -> None:
    stopped = debugged(recorded, "e/player", "--from-tick", "39")
    stopped.ask("back")
    began_us = monotonic_us()
    stopped.ask("back 20")
    assert monotonic_us() - began_us < 1_000_000
    stopped.type("q")
    assert stopped.end() == 0


def test_commands_may_come_from_a_pipe(recorded: Path) -> None:
    asked = "p ('at', self.clock.tick)\nback 3\np ('at', self.clock.tick)\ngoto 25\np ('at', self.clock.tick)\nq\n"
    command = [sys.executable, "-m", "fwk.cli.main", "replay", "log.lcm", "--debug", "e/player", "--from-tick", "20"]
    done = subprocess.run(command, cwd=recorded, input=asked, capture_output=True, text=True, timeout=60)
    assert re.findall(r"\('at', (\d+)\)", done.stdout) == ["20", "17", "25"]
    assert "Deleted breakpoint" not in done.stdout
