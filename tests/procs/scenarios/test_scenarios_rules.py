"""Rules of a scenario: which of them all components share."""

from pathlib import Path
from typing import Any

import pytest

from procs.model.robot import Player
from procs.scenarios.file import ScenarioError, parsed
from procs.scenarios.scenario import launch_file_of, read, run, system_of
from tests.procs.scenarios.scenario_files import written

ALPHA = """
robots: [alpha]
seeing: [beta]
rules: {players: {alpha: {team: cyan, number: 2}, beta: {team: magenta, number: 3}}}
always: [ball_speed < 9]
time_s: 0.5
"""


def test_players_of_the_rules_play_in_all_components(tmp_path: Path) -> None:
    command = "commands: [{at_s: 0.2, referee: {name: red_card, robot: alpha}}]\n"
    assert run(written(tmp_path, ALPHA + command)).ok
    configs: dict[str, Any] = {
        name: getattr(runner.component, "config", None)
        for name, runner in system_of(parsed(ALPHA, "mine")).runners.items()
    }
    players = {name: config.players for name, config in configs.items() if hasattr(config, "players")}
    assert {name.rpartition("/")[2] for name in players} >= {"simulator", "referee", "agent", "world_model"}
    stated = {"alpha": Player(team="cyan", number=2), "beta": Player(team="magenta", number=3)}
    assert all(each == stated for each in players.values())
    assert launch_file_of(parsed(ALPHA, "mine"), "mine").count(" alpha:\n") == len(players)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("rules: {field: {length_m: 12.0}}\nball: {x_m: 9}", "ball: .* is outside the walls; x is at most 7 m"),
        (
            "rules: {players: {}}\nsettings: {world/simulator: {players: {}}}",
            "mine.yaml:2: settings: 'players' of world/simulator is stated under rules, too; keep one",
        ),
        (
            "dummies: [a, b]\nrules: {players: {a: {team: cyan, number: 2}, b: {team: cyan, number: 2}}}",
            "world/simulator: players: .* are both cyan 2",
        ),
        (
            "robots: [alpha]",
            r"'alpha' plays for no team; names such as cyan1 tell it, or rules: {players: {alpha: {team",
        ),
        (
            "dummies: [a]\nsettings: {world/simulator: {players: {a: {team: cyan, number: 2}}}}",
            "mine.yaml:2: settings: 'players' of world/simulator is not that of all components; state it under rules:",
        ),
        (
            "robots: [cyan1]\nsettings: {cyan1/agent: {field: {length_m: 18}}}",
            "mine.yaml:2: settings: 'field' of cyan1/agent is not that of all components; state it under rules:",
        ),
        ("settings: {shared: {realism: harsh}}", "no component 'shared'; write realism: beside settings:, and field"),
    ],
)
def test_mistake_in_shared_rules_is_named(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(ScenarioError, match=message):
        read(written(tmp_path, f"{text}\nat_end: [ball_speed < 9]\n"))


def test_players_stated_for_each_component_are_right(tmp_path: Path) -> None:
    players = "{players: {a: {team: cyan, number: 2}}}"
    settings = f"settings: {{world/simulator: {players}, world/referee: {players}}}"
    assert run(written(tmp_path, f"dummies: [a]\n{settings}\nat_end: [ball_speed < 9]\ntime_s: 0.1\n")).ok
