"""The history of the match, which is written seldom, reaches a reader and a referee that are restarted."""

import json
from collections.abc import Sequence
from pathlib import Path

import pytest

from lcmtypes.soccer import game_state_t
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

PENALTY, MAGENTA = game_state_t.PENALTY, game_state_t.TEAM_MAGENTA
FIELD = Path(__file__).parents[3] / "launch" / "msl-field.yaml"
FILES = {
    "match.yaml": f"include: {FIELD}\nname: match\ncomponents: {{world/reader: {{use: 'reader:Reader'}}}}\n",
    "reader.py": """
from fwk import Component, Reads, Writes
from lcmtypes.soccer import match_history_t


class Reader(Component):
    stage = "think"
    match_history: Reads[match_history_t]
    seen: Writes[match_history_t]

    def loop(self) -> None:
        self.seen.value.events = self.match_history.value.events
        self.seen.write()
""",
}


def test_restarted_reader_has_the_history_of_the_match(launch: Launch, ports: PortBlock, tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    run = Steered(launch("match.yaml", "--speed", "1"), ports)
    run.fwk("call", "world/referee_command", "name=goal", "team=cyan")
    run.ticks_pass()
    run.fwk("restart", "world/reader")
    run.ticks_pass()
    recording = Recording(run.end())
    seen = [each for each in recording.decoded("world/seen") if each.header.writer == "world/reader#2"]
    assert {tuple(event.goal for event in each.events) for each in seen} == {(False, True, False)}
    assert _histories(recording) == [("world/referee", 1), ("world/referee", 3)]


def test_restarted_referee_goes_on_with_the_match(launch: Launch, ports: PortBlock, tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    run = Steered(launch("match.yaml", "--speed", "1"), ports)
    run.fwk("call", "world/referee_command", "name=second_half")
    run.fwk("call", "world/referee_command", "name=goal", "team=cyan")
    run.ticks_pass()
    run.fwk("restart", "world/referee")
    run.ticks_pass()
    recording = Recording(run.end())
    last = recording.decoded("world/game_state")[-1]
    assert (last.header.writer, last.half, last.score_cyan, last.decisions) == ("world/referee#2", 2, 1, 4)
    counts = [("world/referee", 1), ("world/referee", 2), ("world/referee", 4), ("world/referee#2", 4)]
    assert _histories(recording) == counts


@pytest.mark.parametrize("verbs", [("restart",), ("kill", "start")])
def test_stopped_game_stays_so_after_a_restart(
    launch: Launch, ports: PortBlock, tmp_path: Path, verbs: Sequence[str]
) -> None:
    write_files(tmp_path, FILES)
    run = Steered(launch("match.yaml", "--speed", "20", "--set", "world/referee.kick_off_stoppage_s=3"), ports)
    run.fwk("call", "world/referee_command", "name=penalties")
    for name in ("goal", "subgoal"):
        run.fwk("call", "world/referee_command", f"name={name}", "team=cyan")
    run.fwk("call", "world/referee_command", "name=stop")
    for verb in verbs:
        run.fwk(verb, "world/referee")
    run.ticks_pass(600)
    recording = Recording(run.end())
    states, memories = recording.decoded("world/game_state"), recording.decoded("world/referee_memory")
    after = [each for each in states if each.header.writer == "world/referee#2"]
    assert len(after) > 400
    assert all(each.stopped and each.state == PENALTY and each.state_team == MAGENTA for each in after)
    before, following = (
        [json.loads(each.text) for each in memories if each.header.writer == f"world/referee{again}"]
        for again in ("", "#2")
    )
    assert following[0]["shootout"] == before[-1]["shootout"]
    assert '"goals": {"dict": [{"tuple": [{"Team": 1}, 0]}' in memories[-1].text


def _histories(recording: Recording) -> list[tuple[str, int]]:
    """Returns writer and number of events of the histories, in their order; one that is told again counts once."""
    return list(dict.fromkeys((each.header.writer, each.n) for each in recording.decoded("world/match_history")))
