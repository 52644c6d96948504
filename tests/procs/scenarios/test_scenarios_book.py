"""All scenarios of the book succeed, and their runner says what goes wrong."""

import re
from pathlib import Path
from typing import Any

import pytest

from fwk.testing import Expression, ExpressionError, Verdict
from lcmtypes.soccer import line_points_t
from procs.scenarios import command, evaluation
from procs.scenarios.dummy import Dummy
from procs.scenarios.file import BOOK, Scenario, parsed
from procs.scenarios.scenario import outcome, read, run, system_of
from procs.scenarios.words import WORDS
from tests.procs.scenarios.scenario_files import written

SCENARIOS = sorted(BOOK.glob("*.yaml"))


@pytest.mark.slow
@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_scenario(path: Path) -> None:
    verdict = run(path)
    assert verdict.broken == []


@pytest.mark.parametrize(
    "name", [*(f"keeper-saves-{side}" for side in ("centre", "left", "right")), "keeper-catches-a-lob"]
)
def test_shot_on_a_goal_without_its_keeper_goes_in(name: str) -> None:
    scenario = read(BOOK / f"{name}.yaml").model_copy(update={"robots": ["cyan2"], "eventually": []})
    (broken,) = outcome(scenario).broken
    assert broken.endswith('s: not "goal" not in events')


def test_book_has_scenarios_that_say_what_they_are_for() -> None:
    assert len(SCENARIOS) >= 40
    assert all(path.read_text().startswith("# ") for path in SCENARIOS)
    for scenario in (parsed(path.read_text(), str(path)) for path in SCENARIOS):
        assert scenario.eventually or scenario.in_order or scenario.always or scenario.at_end


@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_nothing_that_must_happen_holds_from_the_start(path: Path) -> None:
    """A condition that holds as soon as the ball lies at its place would say nothing about the play."""
    scenario = read(path)
    system = system_of(scenario)
    system.tick(3)
    for text in scenario.eventually:
        assert not Expression(text, WORDS).holds(system.newest), text


def test_ball_in_the_centre_before_it_is_laid_does_not_count() -> None:
    text = "dummies: [cyan2]\nball: {x_m: -6.0, y_m: 0.0}\neventually: [x(ball) > -2]\ntime_s: 1\n"
    assert outcome(parsed(text, "mine.yaml")).broken == ["never: x(ball) > -2"]


def test_same_scenario_ends_at_the_same_time_again() -> None:
    path = BOOK / "shot-on-an-empty-goal.yaml"
    assert run(path) == run(path)


@pytest.mark.parametrize("realism", ["none", "harsh"])
def test_realism_reaches_bodies_percepts_radio_and_stated_errors(realism: str) -> None:
    text = f"seeing: [cyan3]\nrobots: [cyan2]\nrealism: {realism}\nalways: [x(cyan3) < 9]\ntime_s: 1\n"
    runners = system_of(parsed(text, "mine.yaml")).runners
    parts = ["world/simulator", "team_cyan/radio", "cyan2/base"]
    parts += [f"cyan3/{part}" for part in ("percepts", "base", "localization", "world_model")]
    stated: dict[str, Any] = {part: runners[part].component for part in parts}
    assert {part: component.config.realism for part, component in stated.items()} == dict.fromkeys(parts, realism)


def test_robots_see_in_turns_as_in_the_launch_files() -> None:
    system = system_of(parsed("seeing: [cyan2, cyan3]\nalways: [x(cyan3) < 9]\ntime_s: 1\n", "mine.yaml"))
    system.tick(4)
    seen = {
        name: [line_points_t.decode(data) for data in system.sent[f"{name}/line_points"]] for name in ("cyan2", "cyan3")
    }
    assert [message.header.tick for message in seen["cyan2"]] == [2, 4]
    assert [message.header.tick for message in seen["cyan3"]] == [1, 3]


def test_scenario_that_fails_names_the_condition(tmp_path: Path) -> None:
    path = written(tmp_path, "dummies: [cyan2]\neventually: [x(ball) > 1.0]\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")
    assert run(path).broken == ["never: x(ball) > 1.0"]


def test_settings_are_added_to_places_and_rules(tmp_path: Path) -> None:
    text = (
        "robots: [cyan2]\nplaces: {cyan2: [3, 1, 0]}\nrules: {half_s: 0.2}\nalways: [x(cyan2) > 2.9]\ntime_s: 0.3\n"
        "settings: {world/simulator: {stuck_wheels: {cyan2: [1]}}, world/referee: {half_time_s: 9}}\n"
        'at_end: [state("half_time")]\n'
    )
    assert run(written(tmp_path, text)).broken == []


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("pass-is-recieved", "pass-is-recieved: there is no such scenario; did you mean 'pass-is-received'?\n"),
        ("qq", f"qq: there is no such scenario; name a file, or one of those in {BOOK} without its ending\n"),
        (".", ".: it is a folder; name files in it, or none to play the book\n"),
    ],
)
def test_file_that_cannot_be_read_is_named(
    name: str, message: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["scenarios", name])
    assert (command.main(), capsys.readouterr().err) == (2, message)


def test_command_that_is_refused_breaks_a_scenario(tmp_path: Path) -> None:
    text = "dummies: [cyan2]\ncommands: [{referee: {name: subgoal, team: cyan}}]\nalways: [x(cyan2) < 0]\ntime_s: 0.3\n"
    (refused,) = run(written(tmp_path, text)).broken
    assert refused == "refused: the command at 0 s: cyan has no goal to take back; the score is cyan 0:0 magenta"


def test_command_has_nothing_of_the_one_before(tmp_path: Path) -> None:
    text = (
        "dummies: [cyan2, magenta2]\ncommands:\n  - {at_s: 0.1, place_ball: {x_m: 3, y_m: 2, vy_m_s: 1}}\n"
        "  - {at_s: 0.2, place_ball: {x_m: 5}}\n"
        "  - {at_s: 0.3, referee: {name: yellow_card, team: magenta, robot: magenta2}}\n"
        "  - {at_s: 0.4, referee: {name: repair, robot: cyan2}}\n"
        "in_order: [abs(y(ball)) > 1, x(ball) > 4.9 and abs(y(ball)) < 0.1 and ball_speed < 0.1]\ntime_s: 0.8\n"
    )
    assert run(written(tmp_path, text)).broken == []


def test_scenario_freezes_holds_and_resets(tmp_path: Path) -> None:
    text = (
        "robots: [cyan2]\nplaces: {cyan2: [-3.0, 0.0, 0.0]}\nball: {x_m: 4.0, y_m: 3.0}\ncommands:\n"
        "  - {at_s: 1.0, freeze: {frozen: true}}\n  - {at_s: 2.0, freeze: {frozen: false}}\n"
        "  - {at_s: 2.5, hold_robot: {robot: cyan2, held: true}}\n  - {at_s: 3.5, reset: {keep_ball: true}}\n"
        "in_order:\n  - x(cyan2) > -2.8\n  - world.match_events.frozen\n  - not world.match_events.frozen\n"
        "  - x(cyan2) > -1.9 and abs(world.ground_truth.robots[0].vx_m_s) < 0.001\n  - x(cyan2) < -2.9\n"
        "at_end: ['distance(ball, (4.0, 3.0)) < 0.1']\ntime_s: 3.7\n"
    )
    assert run(written(tmp_path, text)).broken == []


@pytest.mark.parametrize(
    ("at_s", "condition", "broken"),
    [
        (0.28, "at_end: [x(cyan2) < 0]", "without an answer: 1 commands"),
        (0.28, "eventually: [x(cyan2) < 0]", "without an answer: 1 commands"),
    ],
)
def test_command_without_an_answer_breaks(tmp_path: Path, at_s: float, condition: str, broken: str) -> None:
    text = f"dummies: [cyan2]\ncommands: [{{at_s: {at_s}, place_ball: {{x_m: 1}}}}]\n{condition}\ntime_s: 0.3\n"
    assert run(written(tmp_path, text)).broken == [broken]


@pytest.mark.parametrize(
    ("condition", "reason"),
    [
        ("touching[0] == 'cyan2'", "an index is beyond the end of its list; ask for its length before: len(...) > 0"),
        ("1 / ball_speed > 0", "it divides by zero; ask for the divisor before: ... != 0 and ..."),
        ("1 % ball_speed > 0", "it divides by zero; ask for the divisor before: ... != 0 and ..."),
    ],
)
@pytest.mark.parametrize("kind", ["eventually", "in_order", "always", "at_end"])
def test_condition_that_fails_in_the_run_names_its_line(kind: str, condition: str, reason: str, tmp_path: Path) -> None:
    text = f"dummies: [cyan2]\n{kind}:\n  - x(cyan2) < 0\n  - {condition}\ntime_s: 0.2\n"
    path = written(tmp_path, text)
    with pytest.raises(ExpressionError, match=re.escape(f"{path}:4: '{condition}': {reason}")):
        run(path)


@pytest.mark.parametrize("text", ["state(kick_off)", "state(kick_off, cyan)", 'state("kick_off", "cyan")'])
def test_states_and_teams_need_no_quotes(tmp_path: Path, text: str) -> None:
    assert run(written(tmp_path, f"dummies: [cyan2]\nalways: ['{text} and x(cyan2) < 0']\ntime_s: 1")).ok


def test_command_prints_a_line_for_each_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = written(tmp_path, "dummies: [cyan2]\nalways: [world.game_state.score_cyan > 0]\ntime_s: 0.2\n")
    monkeypatch.setattr("sys.argv", ["scenarios", "match-ends", str(bad)])
    assert command.main() == 1
    printed = capsys.readouterr().out.splitlines()
    assert printed[0].startswith("ok     match-ends (")
    assert printed[1:] == ["failed mine, seed 1 (0.1 s)", "       0.05 s: not world.game_state.score_cyan > 0"]


def test_scenario_is_played_with_the_seed_of_the_command(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """A seed with which `fwk eval` saw a scenario fail shows the failure again."""
    asked: list[int] = []

    def played(scenario: Scenario) -> Verdict:
        asked.append(scenario.seed)
        return Verdict(1.0, [])

    monkeypatch.setattr(command, "outcome", played)
    for words in (["--seed", "7"], []):
        monkeypatch.setattr("sys.argv", ["scenarios", "pass-is-received", *words])
        assert command.main() == 0
    assert asked == [7, read(BOOK / "pass-is-received.yaml").seed]
    monkeypatch.setattr("sys.argv", ["scenarios", "--seed=-1"])
    with pytest.raises(SystemExit):
        command.main()
    assert "'-1' is not a seed; use a whole number from 0" in capsys.readouterr().err


def test_component_that_fails_breaks_its_scenario_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    text = "dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.1\n"
    good, bad = written(tmp_path, text), tmp_path / "bad.yaml"
    bad.write_text(text.replace("cyan2", "cyan3"))

    def fails(dummy: Dummy) -> None:
        raise ValueError("no wheels")

    monkeypatch.setattr(evaluation, "BOOK", tmp_path)
    monkeypatch.setattr("sys.argv", ["scenarios", str(bad), str(good)])
    turned = Dummy.loop
    monkeypatch.setattr(Dummy, "loop", lambda dummy: fails(dummy) if dummy.name == "cyan3/dummy" else turned(dummy))
    monkeypatch.setattr("procs.scenarios.scenario._check_run", lambda *_: None)
    assert evaluation.played("scenarios.yaml", 1.0, 1) == {"bad": ["ValueError: no wheels"], "mine": []}
    assert command.main() == 1
    shown = capsys.readouterr()
    assert shown.out == "failed bad, seed 1 (0.0 s)\n       ValueError: no wheels\nok     mine (0.1 s)\n"
    assert "Traceback" in shown.err
