"""A branch continues byte for byte as its run, unless something is changed; its recording is replayed as any other."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.harness.logs import Recording, difference
from tests.harness.runs import fwk, played, replayed
from tests.programs.dynamic_channels_system import market
from tests.programs.orchestra import orchestra
from tests.programs.together import together

pytestmark = pytest.mark.system

TICKS = "30"


def grouped(public_url: str) -> dict[str, str]:
    """The orchestra and the lift with a driver that takes the main loop over, several components a host."""
    return together(public_url, real_time=False, groups=True)


def real_time(public_url: str) -> dict[str, str]:
    """The same in real time, with a process for each component."""
    return together(public_url, real_time=True, groups=False)


def recording(folder: Path, files: Callable[[str], dict[str, str]], launch_file: str, ticks: str = TICKS) -> Path:
    return played(folder, files, f"launch/{launch_file}", "--ticks", ticks, "--speed", "max", "--record", "log.lcm")


def branched(folder: Path, tick: int, *words: str, code: int = 0) -> str:
    """Returns the output of a branch into `branch.lcm`."""
    options = ("--to-tick", str(tick), "--then-live", "--record", "branch.lcm")
    return fwk(folder, "replay", "log.lcm", *options, *words, code=code)


@pytest.mark.parametrize(
    ("files", "launch_file", "tick"),
    [
        pytest.param(orchestra, "orchestra.yaml", 12, id="camera and time source"),
        pytest.param(market, "market.yaml", 12, id="dynamic channels"),
        pytest.param(grouped, "together.yaml", 10, id="requests and another main loop"),
    ],
)
def test_an_unchanged_branch_equals_its_run(
    tmp_path: Path, files: Callable[[str], dict[str, str]], launch_file: str, tick: int
) -> None:
    log = recording(tmp_path, files, launch_file, "27")
    assert f"live from tick {tick + 1} to tick 27: " in branched(tmp_path, tick)
    assert difference(log, tmp_path / "branch.lcm") == ""
    replayed(tmp_path, log="branch.lcm")
    assert not list(tmp_path.glob(".cache/fwk/runs/*branch*"))


def test_a_changed_branch_parts_from_its_run_after_the_tick(tmp_path: Path) -> None:
    recording(tmp_path, orchestra, "orchestra.yaml")
    branched(tmp_path, 20, "--set", "d/player.bursts=0", "--until-tick", "40")
    said = fwk(tmp_path, "compare", "log.lcm", "branch.lcm", code=1)
    assert said.startswith("different: d/burst: tick 21, stage 5, "), said
    assert "d/player: d/burst, d/note, from tick 21 on" in said
    replayed(tmp_path, log="branch.lcm")
    other = (tmp_path / "player.py").read_text().replace("note.iterations += 1", "note.iterations += 2")
    (tmp_path / "other.py").write_text(other)
    answer = json.loads(branched(tmp_path, 20, "--with", "e/player=other:Player", "--json"))
    assert (answer["branch_tick"], answer["last_tick"], answer["absent"], answer["differing_before"]) == (
        20,
        30,
        {},
        [],
    )
    said = fwk(tmp_path, "compare", "log.lcm", "branch.lcm", code=1)
    assert "e/note: tick 21, stage 5, message 21 by e/player: iterations is 21 in log.lcm, 42 in branch.lcm" in said
    replayed(tmp_path, "--from-tick", "21", log="branch.lcm")


def test_what_prevents_a_branch_is_explained(tmp_path: Path) -> None:
    recording(tmp_path, orchestra, "orchestra.yaml")
    for words, reason in (
        (["--set", "d/player.bursty=0"], "error: --set: d/player: no setting 'bursty'; did you mean 'bursts'?"),
        (
            ["--with", "d/players=player:Player"],
            "error: --with d/players: no such component in this run; did you mean 'd/player'?",
        ),
        (["--with", "d/player=player:Conductor"], "error: --with d/player=player:Conductor: its ports are none, those"),
        (["--with", "d/player=player:Nobody"], "AttributeError: module 'player' has no attribute 'Nobody'"),
        (["--with", "d/player"], "error: --with d/player: write NAME=module:Class"),
        (["--until-tick", "9"], "no live tick after tick 10; choose a later end with --until-tick"),
        (["--only", "d/player"], "--then-live runs all components without a debugger"),
    ):
        assert reason in branched(tmp_path, 10, *words, code=2), reason
    assert "log.lcm: no tick 31; the last one is 30" in branched(tmp_path, 31, code=2)
    assert "--then-live needs --to-tick N" in fwk(tmp_path, "replay", "log.lcm", "--then-live", code=2)
    file = tmp_path / "player.py"
    failing = "        self.note.write()\n        1 / (self.clock.tick - 25 or self.name != 'f/player')"
    file.write_text(file.read_text().replace("        self.note.write()", failing, 1))
    said = branched(tmp_path, 10, code=1)
    assert "error: f/player fails in tick 25 of the branch\n" in said
    assert "branch.lcm: holds the branch until then" in said
    assert Recording(tmp_path / "branch.lcm").records[-1].tick == 24
    file.write_text(
        file.read_text().replace("note.iterations += 1", "note.iterations += 1 + (self.name == 'a/player')", 1)
    )
    said = branched(tmp_path, 10, "--until-tick", "12")
    assert "up to tick 10 these write something else than in the run, so their state differs: a/player" in said


def test_a_branch_of_a_run_in_real_time_goes_on_in_lockstep(tmp_path: Path) -> None:
    played(tmp_path, real_time, "launch/together.yaml", "--ticks", TICKS, "--record", "log.lcm")
    said = branched(tmp_path, 20, "--until-tick", "60")
    assert "live from tick 21 to tick 60: " in said
    replayed(tmp_path, log="branch.lcm")
    ticks = [record.tick for record in Recording(tmp_path / "branch.lcm").records]
    assert ticks == list(range(1, 61))
