"""A scenario is played by hand in a match of real processes."""

import math
from pathlib import Path

import pytest

from fwk.lcm import messages
from procs.scenarios.file import BOOK
from procs.scenarios.scenario import launch_file_of, read, system_of
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import PortBlock, write_files
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

LAUNCH = Path(__file__).parents[3] / "launch"
FILES = {
    "match.yaml": f"include: [{LAUNCH}/msl-field.yaml, {LAUNCH}/msl-truth.yaml]\nname: match\n"
    "robots: {cyan2: {use: msl_robot_truth}, magenta2: {use: msl_robot_truth}}\n",
    "mine.yaml": """
# A shot that nobody keeps.
robots: [cyan2]
dummies: [magenta2]
places: {cyan2: [5.0, 0.0, 0.0], magenta2: [-3.0, 4.0, 0.0]}
ball: {x_m: 6.0, y_m: 0.5}
commands: [{at_s: 0.2, freeze: {frozen: true}}, {at_s: 0.4, freeze: {frozen: false}}]
eventually: [world.game_state.score_cyan == 1]
time_s: 0.6
""",
}


def test_scenario_of_a_file_is_played_and_replayed(launch: Launch, ports: PortBlock, tmp_path: Path) -> None:
    write_files(tmp_path, FILES)
    run = Steered(launch("match.yaml", "--speed", "2"), ports)
    run.ask("pause")  # on a slow machine many ticks would pass between the commands, and a replay of them takes minutes
    unloaded = run.fwk("call", "world/scenario", "name=match-ends", "--timeout", "1000", code=1)
    assert "world/scenario: not sent, because world/crew is stopped: " in unloaded
    assert "world/crew is stopped: does not start with the run; 'fwk load' starts it" in unloaded
    run.fwk("load", "world/crew")
    assert "mine.yml: No such file or directory" in run.fwk("call", "world/scenario", "text=@mine.yml", code=2)
    run.ask("resume")
    wrong = run.fwk("call", "world/scenario", "name=match-end", code=1)
    assert "rejected" in wrong
    assert "no scenario 'match-end' in the book; did you mean 'match-ends'?" in wrong
    assert run.fwk("call", "world/scenario", "text=@mine.yaml").startswith("world/scenario: done, tick ")
    begun = run.tick
    run.launched.until_true(lambda: run.tick > begun + 20, "the end of the scenario")
    log = run.end()
    recording = Recording(log)
    truths = recording.decoded("world/ground_truth")
    there = [
        each
        for each in truths
        if math.dist((each.robots[0].x_m, each.robots[0].y_m), (5.0, 0.0)) < 0.01
        and math.dist((each.robots[1].x_m, each.robots[1].y_m), (-3.0, 4.0)) < 0.01
    ]
    assert len(there) >= 25  # the world stands still for a second
    assert any(math.dist((each.ball_x_m, each.ball_y_m), (6.0, 0.5)) < 0.01 for each in truths)
    assert [each.frozen for each in recording.decoded("world/freeze@world/crew")] == [True, False, True, False]
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")


def test_launch_file_of_a_scenario_plays_the_same(launch: Launch, ports: PortBlock, tmp_path: Path) -> None:
    scenario = read(BOOK / "carried-off-robot-finds-its-place.yaml").model_copy(update={"seed": 7})
    write_files(tmp_path, {"mine.yaml": launch_file_of(scenario, "mine")})
    run = launch("mine.yaml", "--ticks", "40", "--speed", "max", "--record", "log.lcm")
    assert run.wait() == 0, run.text
    recording, system = Recording(tmp_path / "log.lcm"), system_of(scenario)
    system.tick(40)
    for channel in ("world/ground_truth", "world/game_state", "cyan2/pose", "cyan2/wheel_command"):
        kind = type(system.newest(channel))
        played = [repr(messages.decode(kind, data, channel)) for data in system.sent[channel]]
        assert len(played) > 15
        assert list(map(repr, recording.decoded(channel))) == played, channel
