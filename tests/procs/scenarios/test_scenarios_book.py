"""All scenarios of the book succeed, and their runner says what goes wrong."""

import re
from pathlib import Path

import pytest

from fwk.testing import ExpressionError, Verdict
from procs.scenarios import command, evaluation
from procs.scenarios.dummy import Dummy
from procs.scenarios.file import BOOK, Scenario, ScenarioError
from procs.scenarios.scenario import read, run

SCENARIOS = sorted(BOOK.glob("*.yaml"))


@pytest.mark.slow
@pytest.mark.parametrize("path", SCENARIOS, ids=lambda path: path.stem)
def test_scenario(path: Path) -> None:
    verdict = run(path)
    assert verdict.broken == []


def test_book_has_scenarios_that_say_what_they_are_for() -> None:
    assert len(SCENARIOS) >= 40
    assert all(path.read_text().startswith("# ") for path in SCENARIOS)
    for scenario in map(read, SCENARIOS):
        assert scenario.eventually or scenario.in_order or scenario.always or scenario.at_end


def test_same_scenario_ends_at_the_same_time_again() -> None:
    path = BOOK / "shot-on-an-empty-goal.yaml"
    assert run(path) == run(path)


def written(folder: Path, text: str) -> Path:
    path = folder / "mine.yaml"
    path.write_text(text)
    return path


def test_scenario_that_fails_names_the_condition(tmp_path: Path) -> None:
    path = written(tmp_path, "dummies: [cyan2]\neventually: [x(ball) > 1.0]\nalways: [x(cyan2) < 0]\ntime_s: 0.2\n")
    assert run(path).broken == ["never: x(ball) > 1.0"]


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("robot: [cyan2]", ScenarioError, "mine.yaml: no key 'robot'; did you mean 'robots'?"),
        ("", ScenarioError, "mine.yaml: holds no keys"),
        ("- cyan2", ScenarioError, "mine.yaml: holds no keys"),
        ("robots: [cyan2]", ScenarioError, "nothing has to happen; give eventually, in_order"),
        ("robots: [cyan2]\ndummies: [cyan2]", ScenarioError, "'cyan2' is named 2 times"),
        ("robots: [anna]\nat_end: [ball_speed < 1]", ScenarioError, "'anna' plays for no team; names such as cyan1"),
        ("robots: [my robot]", ScenarioError, "'my robot' is not a name"),
        ("robots: [cyan2]\nplaces: {cyan3: [0, 0, 0]}", ScenarioError, "places: no robot 'cyan3'; there are cyan2"),
        (
            "robots: [cyan2]\nplaces: {cyan2: [0, 0]}",
            ScenarioError,
            "places.cyan2: it should be the numbers x_m, y_m and",
        ),
        (
            "settings: {world/simulator: {players: {cyan2: {number: 1}}}}",
            ScenarioError,
            "mine.yaml: world/simulator.players.cyan2: team is missing",
        ),
        ("ball: {x: 1}", ScenarioError, "ball: there is no 'x'; there are x_m"),
        ("realism: best", ScenarioError, "realism: .*'harsh'"),
        ("seed: -1", ScenarioError, "seed: "),
        ("rules: {half: 1}", ScenarioError, "rules: no key 'half'; did you mean 'half_s'?"),
        ("settings: {cyan2/agent: {}}\nrobots: [cyan1]", ScenarioError, "no component 'cyan2/agent'; did you mean"),
        ("settings: {world/referee: {half_s: -1}}", ScenarioError, "world/referee.half_s: Input should be greater"),
        ("settings: {world/crew: {actions: []}}", ScenarioError, "settings: world/crew has its actions under commands"),
        ("commands: [{at_s: 1}]", ScenarioError, "commands.0: give one of place_ball, place_robot, hold_robot"),
        ("commands: [{place_ball: {x: 1}}]", ScenarioError, "commands.0: place_ball: there is no 'x'; there are x_m"),
        ("commands: [{place_robot: {x_m: left}}]", ScenarioError, "x_m is 'left'; it should be a number"),
        ("robots: [", ScenarioError, "mine.yaml:1: expected"),
        ("robots: [cyan2]\nalways: [x]\nalways: [y]", ScenarioError, "mine.yaml:3: 'always' is given twice"),
        ("robots: [cyan2]\nplaces: {cyan2: [1, 0, 0], cyan2: [2, 0, 0]}", ScenarioError, "'cyan2' is given twice"),
        ("robots: [cyan2]\ntime_s: yes", ScenarioError, "time_s: Input should be a valid number"),
        ("ball: {x_m: true}", ScenarioError, "ball.x_m: Input should be a valid number"),
        ("seed: true", ScenarioError, "seed: Input should be a valid integer"),
        (
            "robots: [cyan2]\nat_end: [reasons]\ncommands: [{place_robot: {robot: cyan3}}]",
            ScenarioError,
            "commands.0: place_robot: no robot 'cyan3'; did you mean 'cyan2'?",
        ),
        ("dummies: [cyan2]\nalways: ['\"cyan3\" not in touching']", ScenarioError, "no robot 'cyan3'; did you mean"),
        (
            "always: ['\"duoble touch\" not in reasons']",
            ScenarioError,
            "no reason 'duoble touch'; did you mean 'double",
        ),
        (
            "at_end: [reasons]\ncommands: [{referee: {name: kickof}}]",
            ScenarioError,
            "no command 'kickof'; did you mean",
        ),
        ("at_end: [reasons]\ncommands: [{referee: {team: cyan}}]", ScenarioError, "no command ''; there are kickoff"),
        ("robots: [cyan2]\nplaces: {cyan2: [100, 0, 0]}\nat_end: [ball_speed < 1]", ScenarioError, "outside the walls"),
        ("dummies: [a1, b1]\nplaces: {a1: [0, 0, 0], b1: [0, 0, 0]}\nat_end: [touching]", ScenarioError, "0 m apart"),
        ("robots: [cyan2]\nplaces: {cyan2: [.nan, 0, 0]}", ScenarioError, "places.cyan2.0: .* finite number"),
        (
            "at_end: [reasons]\ntime_s: 1\ncommands: [{at_s: 1, place_ball: {}}]",
            ScenarioError,
            "at_s is 1; the scenario",
        ),
        ("robots: [cyan1]\nat_end: [frobnicate(cyan1)]", ScenarioError, "calls only abs, ball"),
        ("eventually: ['x(ball']", ScenarioError, "never closed"),
        ("dummies: [cyan2]\neventually: [x(cyan3) > 0]", ScenarioError, "no robot 'cyan3'; did you mean 'cyan2'?"),
        ("dummies: [cyan2]\nalways: [x(ball) < 9 or x(cyan3) > 0]", ScenarioError, "no robot 'cyan3'; did you mean"),
        ("dummies: [a]\neventually: [world.game_stat.half > 0]", ScenarioError, "did you mean 'world/game_state'?"),
        ("dummies: [a]\nat_end: ['state(\"plan\")']", ScenarioError, "no state 'plan'; did you mean 'play'?"),
        ('dummies: [a]\nat_end: [\'state("play", "red")\']', ScenarioError, "no team 'red'; there are cyan, magenta"),
        ("dummies: [a]\nat_end: [bal_speed < 1]", ScenarioError, "no 'bal_speed'; did you mean 'ball_speed'?"),
        ("at_end: [ball_speed < 1]\ntime_s: .inf", ScenarioError, "time_s: .*finite number"),
        ("at_end: [ball_speed < 1]\ntime_s: .nan", ScenarioError, "time_s: "),
        ("at_end: [ball_speed < 1]\nball: {x_m: .nan}", ScenarioError, "ball.x_m: .*finite number"),
        ("commands: [{at_s: .nan, place_ball: {}}]", ScenarioError, "commands.0.at_s: "),
        ("commands: [{place_robot: {x_m: .inf}}]", ScenarioError, "x_m is inf; it should be a finite number"),
        ("robots: [cyan1]\ntime_s: 2026-13-45", ScenarioError, "mine.yaml:2: no such value: month must be in 1..12"),
        (f"seed: {'9' * 5000}", ScenarioError, "mine.yaml:1: no such value: Exceeds the limit"),
        (f"robots: {'[' * 2000}{']' * 2000}", ScenarioError, "mine.yaml: its values are nested too deep"),
        ("robots: [cyan1, cyan01]\nat_end: [reasons]", ScenarioError, "players: cyan01 and cyan1 are both cyan 1"),
        (
            "robots: [cyan1]\nat_end: [reasons]\nsettings: {world/simulator: {stuck_wheels: {cyan2: [1]}}}",
            ScenarioError,
            "mine.yaml: world/simulator: stuck_wheels: no robot 'cyan2'; there are: cyan1",
        ),
        (
            "robots: [cyan1]\nat_end: [reasons]\ncommands: [{referee: {name: repair, robot: cyan2}}]",
            ScenarioError,
            "commands.0: referee: no robot 'cyan2'; did you mean 'cyan1'?",
        ),
        (
            "robots: [cyan1]\nat_end: [reasons]\ncommands: [{referee: {name: corner, team: red}}]",
            ScenarioError,
            "commands.0: referee: no team 'red'; there are cyan, magenta",
        ),
        ("robots: [cyan]\nat_end: [reasons]", ScenarioError, "robots: 'cyan' plays for no team; names such as cyan1"),
        ("seeing: [cyan0]\nat_end: [reasons]", ScenarioError, "robots: 'cyan0' plays for no team"),
        (f"robots: [cyan{9**20}]", ScenarioError, "has a number that is too large; use one of nine digits at most"),
        (f"dummies: [cyan{'9' * 5000}]", ScenarioError, "has a number that is too large"),
        (
            "settings: {world/simulator: {players: {cyan1: {team: cyan, number: 9999999999}}}}",
            ScenarioError,
            "world/simulator.players.cyan1.number: Input should be less than or equal to 2147483647",
        ),
        ("robots: [me]\nsettings: {world/referee: {players: 3}}", ScenarioError, "'me' plays for no team"),
        ("ball: {x_m: 12.5}", ScenarioError, r"mine.yaml: ball: \(12.5, 0\) is outside the walls; x is at most 12 m"),
        ("ball: {z_m: 9}", ScenarioError, "mine.yaml: ball: z_m is 9.0; it should be from 0 to 5"),
        (
            "commands: [{place_ball: {vx_m_s: 99}}]",
            ScenarioError,
            "commands.0: place_ball: vx_m_s is 99.0; it should be",
        ),
        (
            "robots: [cyan1]\ncommands: [{place_robot: {robot: cyan1, y_m: -8.5}}]",
            ScenarioError,
            r"commands.0: place_robot: \(0, -8.5\) is outside the walls; x is at most 12 m, y 8 m",
        ),
        ("commands: [{referee: {name: goal}}]", ScenarioError, "commands.0: referee: 'goal' needs a team: cyan or"),
        ("commands: [{referee: {name: throwin}}]", ScenarioError, "commands.0: referee: 'throwin' needs a team"),
        (
            "commands: [{referee: {name: repair}}]",
            ScenarioError,
            "commands.0: referee: 'repair' needs a team or a robot",
        ),
        (
            "robots: [cyan1]\ncommands: [{referee: {name: red_card, robot: cyan1, team: magenta}}]",
            ScenarioError,
            "commands.0: referee: cyan1 does not play for magenta",
        ),
        ("commands: [{at_s: '1', reset: {}}]", ScenarioError, "commands.0.at_s: Input should be a valid number"),
        ("commands: [{at_s: true, reset: {}}]", ScenarioError, "commands.0.at_s: Input should be a valid number"),
        (
            "commands: [{at_s: -1, reset: {}}]",
            ScenarioError,
            "commands.0.at_s: Input should be greater than or equal to 0",
        ),
        ("time_s: 1.0e+300", ScenarioError, "time_s: Input should be less than or equal to 86400"),
        (
            "commands: [{freeze: {}}]",
            ScenarioError,
            "commands.0: freeze: frozen is missing; it should be true or false",
        ),
        ("commands: [{freeze: {frozen: 1}}]", ScenarioError, "commands.0: freeze: frozen is 1; it should be a bool"),
        ("commands: [{freeze: true}]", ScenarioError, "commands.0.freeze: Input should be a valid dictionary"),
        (
            "commands: [{reset: {ball: true}}]",
            ScenarioError,
            "commands.0: reset: there is no 'ball'; there are keep_ball",
        ),
        ("commands: [{hold_robot: {robot: cyan2, held: true}}]", ScenarioError, "hold_robot: no robot 'cyan2'"),
        ("robots: [cyan1]\ncommands: [{place_robot: {}}]", ScenarioError, "place_robot: no robot ''; there are cyan1"),
    ],
)
def test_bad_scenario_is_named(tmp_path: Path, text: str, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message.replace("?", r"\?")):
        run(written(tmp_path, text))


def test_file_of_bytes_is_not_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioError, match=r"mine.yaml: .*utf-8"):
        run(path)


def test_all_mistakes_of_all_files_come_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = written(tmp_path, "robots: [cyan1, cyan1]\nplaces: {cyan2: [0, 0, 0]}\n")
    monkeypatch.setattr("sys.argv", ["scenarios", "match-ends", str(bad), "no-such"])
    assert command.main() == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert [line.count("mine.yaml") for line in printed.err.splitlines()] == [1, 1, 1, 0]


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
        ("qq", "qq: there is no such scenario\n"),
        (".", ".: Is a directory\n"),
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
    assert refused == "refused: the command at 0 s: cyan has no goal to take back"


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
    ("text", "message"),
    [
        ("ball < 3", "'<' compares two numbers, but ball is a Point; take one of its fields, such as ball.x_m"),
        ("distance(ball)", "distance takes 2 values (one, two); here is 1"),
        ("x()", "x takes 1 value (place); here are none"),
        ("x", "x is a function, which always holds; call it: x(...)"),
        ("ball_speed()", "ball_speed is a number, not a function; write it without brackets"),
        ("distance(ball, 3) > 1", "a place is the ball, a robot by its name, or two numbers as in (1.0, -2.0)"),
        ("x((1, 2, 3)) > 1", "a place is the ball, a robot by its name, or two numbers"),
        ("y(state) > 1", "a place is the ball, a robot by its name, or two numbers"),
        ("touching == 'cyan2'", "'==' compares values of one kind, but touching is a list and 'cyan2' is a text"),
        ("world.game_state", "world.game_state is a game_state_t, which always holds"),
    ],
)
def test_type_mistake_in_a_condition_is_named(tmp_path: Path, text: str, message: str) -> None:
    path = written(tmp_path, f'dummies: [cyan2]\nalways: ["{text}"]\n')
    with pytest.raises(ScenarioError, match=re.escape(f"{path}: '{text}': {message}")):
        read(path)


def test_condition_that_fails_in_the_run_names_the_file(tmp_path: Path) -> None:
    path = written(tmp_path, "dummies: [cyan2]\nalways: [\"touching[0] == 'cyan2'\"]\ntime_s: 0.2\n")
    with pytest.raises(ExpressionError, match=re.escape(f"{path}: 'touching[0] == 'cyan2'': an index is beyond")):
        run(path)


@pytest.mark.parametrize("text", ["state(kick_off)", "state(kick_off, cyan)", 'state("kick_off", "cyan")'])
def test_states_and_teams_need_no_quotes(tmp_path: Path, text: str) -> None:
    assert run(written(tmp_path, f"dummies: [cyan2]\nalways: ['{text} and x(cyan2) < 0']\ntime_s: 1")).ok


@pytest.mark.parametrize("text", ['state("offside")', "world.game_state.goals", "cyan9.role.value", "2 ** 10 ** 10"])
def test_condition_that_cannot_be_judged_is_a_mistake(tmp_path: Path, text: str) -> None:
    with pytest.raises(ScenarioError, match=r"mine.yaml: '.*': "):
        read(written(tmp_path, f"dummies: [cyan2]\nalways: ['{text}']\n"))


def test_command_prints_a_line_for_each_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = written(tmp_path, "dummies: [cyan2]\nalways: [world.game_state.score_cyan > 0]\ntime_s: 0.2\n")
    monkeypatch.setattr("sys.argv", ["scenarios", "match-ends", str(bad)])
    assert command.main() == 1
    printed = capsys.readouterr().out.splitlines()
    assert printed[0].startswith("ok     match-ends (")
    assert printed[1:] == ["failed mine (0.1 s)", "       0.05 s: not world.game_state.score_cyan > 0"]


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
    monkeypatch.setattr("procs.scenarios.scenario._unknown_in", lambda scenario: [])
    assert evaluation.played("scenarios.yaml", 1.0, 1) == {"bad": ["ValueError: no wheels"], "mine": []}
    assert command.main() == 1
    shown = capsys.readouterr()
    assert shown.out == "failed bad (0.0 s)\n       ValueError: no wheels\nok     mine (0.1 s)\n"
    assert "Traceback" in shown.err
