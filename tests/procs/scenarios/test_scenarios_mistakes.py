"""Mistakes of scenario files, each named with its line and with what would be right."""

import os
import re
from pathlib import Path

import pytest

from procs.scenarios import command
from procs.scenarios.file import ScenarioError
from procs.scenarios.scenario import read, run
from tests.procs.scenarios.scenario_files import written


@pytest.mark.parametrize(
    ("text", "error", "message"),
    [
        ("robot: [cyan2]", ScenarioError, "mine.yaml:1: no key 'robot'; did you mean 'robots'?"),
        ("", ScenarioError, "mine.yaml:1: nothing has to happen; give eventually, in_order, always or at_end"),
        ("- cyan2", ScenarioError, "mine.yaml:1: it should be a mapping with keys such as 'name: value'"),
        ("robots: [cyan2]", ScenarioError, "nothing has to happen; give eventually, in_order"),
        ("robots: [cyan2]\ndummies: [cyan2]", ScenarioError, "'cyan2' is named 2 times"),
        ("robots: [anna]\nat_end: [ball_speed < 1]", ScenarioError, "'anna' plays for no team; names such as cyan1"),
        ("robots: [my robot]", ScenarioError, "'my robot' is not a name"),
        ("robots: [cyan2]\nplaces: {cyan3: [0, 0, 0]}", ScenarioError, "places: no robot 'cyan3'; there are cyan2"),
        (
            "robots: [cyan2]\nplaces: {cyan2: [0, 0]}",
            ScenarioError,
            "'places.cyan2' is .0, 0.; it should be the numbers x_m, y_m and",
        ),
        (
            "settings: {world/simulator: {players: {cyan2: {number: 1}}}}",
            ScenarioError,
            "mine.yaml:1: world/simulator: the setting 'players.cyan2.team' is missing",
        ),
        ("ball: {x: 1}", ScenarioError, "ball: there is no 'x'; there are x_m"),
        ("realism: best", ScenarioError, "'realism' is 'best'; it should be .*'harsh'"),
        ("seed: -1", ScenarioError, "'seed' is -1; it should be greater than or equal to 0"),
        ("rules: {half: 1}", ScenarioError, "rules: no setting 'half'; did you mean 'half_s'?"),
        ("settings: {cyan2/agent: {}}\nrobots: [cyan1]", ScenarioError, "no component 'cyan2/agent'; did you mean"),
        (
            "settings: {world/referee: {half_s: -1}}",
            ScenarioError,
            "world/referee: 'half_s' is -1; it should be greater than or equal to 0.1",
        ),
        ("settings: {world/crew: {actions: []}}", ScenarioError, "settings: world/crew has its actions under commands"),
        (
            "rules: {half_s: 9}\nsettings: {world/referee: {half_time_s: 9, half_s: 8}}",
            ScenarioError,
            "mine.yaml:2: settings: 'half_s' of world/referee is stated under rules, too; keep one",
        ),
        (
            "robots: [cyan1]\nplaces: {cyan1: [1, 0, 0]}\nsettings: {world/simulator: {starts: {cyan1: [2, 0, 0]}}}",
            ScenarioError,
            "settings: 'starts' of world/simulator is stated under places, too; keep one",
        ),
        (
            "realism: none\nsettings: {world/simulator: {realism: harsh}}",
            ScenarioError,
            "settings: 'realism' of world/simulator is stated under realism, too; keep one",
        ),
        ("commands: [{at_s: 1}]", ScenarioError, "'commands.0' is {'at_s': 1}; give one of place_ball, place_robot"),
        (
            "commands: [{place_ball: {x: 1}}]",
            ScenarioError,
            "'commands.0' is {'place_ball': {'x': 1}}; place_ball: there is no 'x'; there are x_m",
        ),
        ("commands: [{place_robot: {x_m: left}}]", ScenarioError, "x_m is 'left'; it should be a number"),
        (
            "robots: [",
            ScenarioError,
            "mine.yaml:1: this is not valid YAML: while parsing a flow node that begins in line 1, expected",
        ),
        (
            "robots: [cyan2]\nalways: [x]\nalways: [y]",
            ScenarioError,
            "mine.yaml:3: 'always' occurs a second time, first in line 2",
        ),
        (
            "robots: [cyan2]\nplaces: {cyan2: [1, 0, 0], cyan2: [2, 0, 0]}",
            ScenarioError,
            "mine.yaml:2: 'cyan2' occurs a second time",
        ),
        ("robots: [cyan2]\ntime_s: yes", ScenarioError, "mine.yaml:2: 'time_s' is 'yes'; it should be a valid number"),
        ("ball: {x_m: true}", ScenarioError, "'ball.x_m' is true; it should be a valid number"),
        ("seed: true", ScenarioError, "'seed' is true; it should be a valid integer"),
        (
            "robots: [cyan2]\nat_end: [reasons]\ncommands: [{place_robot: {robot: cyan3}}]",
            ScenarioError,
            "commands.0: place_robot: no robot 'cyan3'; did you mean 'cyan2'?",
        ),
        ("always: ['\"gaol\" not in events']", ScenarioError, "no event 'gaol'; did you mean 'goal'?"),
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
        (
            "robots: [cyan2]\nplaces: {cyan2: [.nan, 0, 0]}",
            ScenarioError,
            "'places.cyan2.0' is nan; it should be a finite number",
        ),
        (
            "at_end: [reasons]\ntime_s: 1\ncommands: [{at_s: 1, place_ball: {}}]",
            ScenarioError,
            "at_s is 1; the scenario",
        ),
        (
            "at_end: [reasons]\nball: {x_m: 1.0}\ntime_s: 0.1",
            ScenarioError,
            "mine.yaml:2: ball: it lies at its place from 0.15 s on; the scenario ends at 0.1 s",
        ),
        ("robots: [cyan1]\nat_end: [frobnicate(cyan1)]", ScenarioError, "calls only abs, ball"),
        ("eventually: ['x(ball']", ScenarioError, "never closed"),
        ("dummies: [cyan2]\neventually: [x(cyan3) > 0]", ScenarioError, "no robot 'cyan3'; did you mean 'cyan2'?"),
        ("dummies: [cyan2]\nalways: [x(ball) < 9 or x(cyan3) > 0]", ScenarioError, "no robot 'cyan3'; did you mean"),
        ("dummies: [a]\neventually: [world.game_stat.half > 0]", ScenarioError, "did you mean 'world/game_state'?"),
        ("dummies: [a]\nat_end: ['state(\"plan\")']", ScenarioError, "no state 'plan'; did you mean 'play'?"),
        ('dummies: [a]\nat_end: [\'state("play", "red")\']', ScenarioError, "no team 'red'; there are cyan, magenta"),
        ("dummies: [a]\nat_end: [bal_speed < 1]", ScenarioError, "no 'bal_speed'; did you mean 'ball_speed'?"),
        ("at_end: [ball_speed < 1]\ntime_s: .inf", ScenarioError, "'time_s' is inf; it should be a finite number"),
        ("at_end: [ball_speed < 1]\ntime_s: .nan", ScenarioError, "'time_s' is nan; it should be a finite number"),
        (
            "at_end: [ball_speed < 1]\nball: {x_m: .nan}",
            ScenarioError,
            "'ball.x_m' is nan; it should be a finite number",
        ),
        (
            "commands: [{at_s: .nan, place_ball: {}}]",
            ScenarioError,
            "'commands.0.at_s' is nan; it should be a finite number",
        ),
        ("commands: [{place_robot: {x_m: .inf}}]", ScenarioError, "x_m is inf; it should be a finite number"),
        (
            "robots: [cyan1]\ntime_s: 2026-13-45",
            ScenarioError,
            "mine.yaml:2: 'time_s' is '2026-13-45'; it should be a valid number",
        ),
        (f"seed: {'9' * 5000}", ScenarioError, "mine.yaml:1: '9{60}' is not a valid int"),
        (
            f"robots: {'[' * 2000}{']' * 2000}",
            ScenarioError,
            "mine.yaml:1: values are nested too deeply; use a few levels",
        ),
        ("robots: [cyan1, cyan01]\nat_end: [reasons]", ScenarioError, "players: cyan01 and cyan1 are both cyan 1"),
        (
            "robots: [cyan1]\nat_end: [reasons]\nsettings: {world/simulator: {stuck_wheels: {cyan2: [1]}}}",
            ScenarioError,
            "mine.yaml:3: world/simulator: stuck_wheels: no robot 'cyan2'; there are: cyan1",
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
        ("robots: [cyan]\nat_end: [reasons]", ScenarioError, "robots.0: 'cyan' plays for no team; names such as cyan1"),
        ("seeing: [cyan0]\nat_end: [reasons]", ScenarioError, "mine.yaml:1: seeing.0: 'cyan0' plays for no team"),
        (
            "robots: [cyan2]\ndummies:\n  - 'mag enta'\n",
            ScenarioError,
            "mine.yaml:3: dummies.0: 'mag enta' is not a name; use letters",
        ),
        (
            "seeing: [cyan2]\ndummies: [magenta2, magenta2]",
            ScenarioError,
            "mine.yaml:2: dummies.1: 'magenta2' is named 2 times",
        ),
        ("dummies: [a]\nrobots: [cyan2]\nseeing: [cyan2]", ScenarioError, "mine.yaml:3: seeing.0: 'cyan2' is named 2"),
        (f"robots: [cyan{9**20}]", ScenarioError, "has a number that is too large; use one of nine digits at most"),
        (f"dummies: [cyan{'9' * 5000}]", ScenarioError, "has a number that is too large"),
        (
            "settings: {world/simulator: {players: {cyan1: {team: cyan, number: 9999999999}}}}",
            ScenarioError,
            "world/simulator: 'players.cyan1.number' is 9999999999; it should be less than or equal to 2147483647",
        ),
        (
            "dummies: [cyan2]\nscripted:\n  magenta2: []\n  cyan2: []",
            ScenarioError,
            "mine.yaml:4: scripted.cyan2: 'cyan2' is named 2 times",
        ),
        (
            "scripted:\n  cyan2: [{at_s: 1}, {at_s: 0.5}]",
            ScenarioError,
            "mine.yaml:2: scripted.cyan2: step 1 begins at 0.5 s; it should begin after 1 s",
        ),
        (
            "scripted:\n  cyan2:\n    - {vx_m_s: 1}\n    - {at_s: 3}\ntime_s: 3",
            ScenarioError,
            "mine.yaml:4: scripted.cyan2.1: at_s is 3; the scenario ends at 3 s",
        ),
        ("scripted: {cyan2: [{speed: 1}]}", ScenarioError, "no key 'scripted.cyan2.0.speed'"),
        ("scripted: {cyan2: [{kick_m_s: -1}]}", ScenarioError, "it should be greater than or equal to 0"),
        ("scripted: {cyan2: [{kick_m_s: .inf}]}", ScenarioError, "is inf; it should be a finite number"),
        ("scripted: {cyan2: [{dribble: 1}]}", ScenarioError, "'scripted.cyan2.0.dribble' is 1; it should be"),
        (
            "scripted: {cyan2: [{vx_m_s: 1}]}\nsettings: {cyan2/script: {steps: []}}\nat_end: [reasons]",
            ScenarioError,
            "'steps' of cyan2/script is stated under scripted, too; keep one",
        ),
        ("dummies: [cyan2]\nat_end: ['\"blue\" in cards(cyan2)']", ScenarioError, "no card 'blue'; there are"),
        ("dummies: [cyan2]\nat_end: [cards(cyan3)]", ScenarioError, "no robot 'cyan3'; did you mean 'cyan2'?"),
        ("robots: [me]\nsettings: {world/referee: {players: 3}}", ScenarioError, "'me' plays for no team"),
        ("ball: {x_m: 12.5}", ScenarioError, r"mine.yaml:1: ball: \(12.5, 0\) is outside the walls; x is at most 12 m"),
        ("ball: {z_m: 9}", ScenarioError, "mine.yaml:1: ball: z_m is 9.0; it should be from 0 to 5"),
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
            "commands.0: referee: cyan1 plays for cyan, not for magenta",
        ),
        ("commands: [{at_s: '1', reset: {}}]", ScenarioError, "'commands.0.at_s' is '1'; it should be a valid number"),
        (
            "commands: [{at_s: true, reset: {}}]",
            ScenarioError,
            "'commands.0.at_s' is true; it should be a valid number",
        ),
        (
            "commands: [{at_s: -1, reset: {}}]",
            ScenarioError,
            "'commands.0.at_s' is -1; it should be greater than or equal to 0",
        ),
        ("time_s: 1.0e+300", ScenarioError, "'time_s' is 1e.300; it should be less than or equal to 86400"),
        (
            "commands: [{freeze: {}}]",
            ScenarioError,
            "'commands.0' is {'freeze': {}}; freeze: frozen is missing; it should be true or false",
        ),
        (
            "commands: [{freeze: {frozen: 1}}]",
            ScenarioError,
            "'commands.0' is {'freeze': {'frozen': 1}}; freeze: frozen is 1; it should be true or false",
        ),
        ("commands: [{freeze: true}]", ScenarioError, "'commands.0.freeze' is true; it should be a mapping"),
        (
            "commands: [{reset: {ball: true}}]",
            ScenarioError,
            "'commands.0' is {'reset': {'ball': True}}; reset: there is no 'ball'; there are keep_ball",
        ),
        ("commands: [{hold_robot: {robot: cyan2, held: true}}]", ScenarioError, "hold_robot: no robot 'cyan2'"),
        (
            "dummies: [cyan2]\nplaces:\n  cyan2: [-3, 0, 90]\nat_end: [reasons]",
            ScenarioError,
            "mine.yaml:3: places.cyan2: heading_rad is 90; it should be from -6.28 to 6.28, in radians",
        ),
        (
            "robots: [cyan1]\ncommands: [{place_robot: {robot: cyan1, heading_rad: -180}}]",
            ScenarioError,
            "commands.0: place_robot: heading_rad is -180; it should be from -6.28 to 6.28, in radians",
        ),
        (
            "commands: [{kick: {}}]",
            ScenarioError,
            "no key 'commands.0.kick'; there are at_s, freeze, hold_robot, place_ball, place_robot",
        ),
        (
            "dummies: [cyan2]\nalways: [x(cyan2) > 0]\ntime_s: 1e-9",
            ScenarioError,
            "mine.yaml:3: 'time_s' is 1e-09; it should be greater than or equal to 0.001",
        ),
        ("dummies: [yes]\nalways: ['']", ScenarioError, "mine.yaml:2: an empty condition; write such as"),
        ("dummies: [cyan2]\nalways: [1 < 2]", ScenarioError, "mine.yaml:2: '1 < 2': a fixed value is no condition"),
        (f"# {'x' * 100_000}", ScenarioError, "mine.yaml: it has 100,002 letters; a scenario has 100,000 at most"),
        (
            f"a: &a [{'x,' * 1000}]\nb: &b [{'*a,' * 1000}]",
            ScenarioError,
            "mine.yaml:1: more than 100000 values when its aliases are written out; use fewer",
        ),
        ("robots: [cyan1]\ncommands: [{place_robot: {}}]", ScenarioError, "place_robot: no robot ''; there are cyan1"),
    ],
)
def test_bad_scenario_is_named(tmp_path: Path, text: str, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message.replace("?", r"\?")):
        run(written(tmp_path, text))


def test_file_of_bytes_is_not_a_scenario(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ScenarioError, match=r"mine.yaml: it is not UTF-8 text"):
        run(path)


@pytest.mark.timeout(60)
def test_device_without_an_end_is_not_a_scenario() -> None:
    with pytest.raises(ScenarioError, match=r"/dev/zero: it has more than 1,000,000 letters; a scenario has 100,000"):
        run(Path("/dev/zero"))


@pytest.mark.timeout(60)
def test_pipe_without_a_writer_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "mine.yaml")
    with pytest.raises(ScenarioError, match=r"mine.yaml: it is a pipe into which no program writes; name a file"):
        run(tmp_path / "mine.yaml")


def test_pipe_is_read_to_its_end(tmp_path: Path) -> None:
    """Shells make one of `<(...)`."""
    ours, theirs = os.pipe()
    os.write(theirs, b"dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.1\n")
    os.close(theirs)
    try:
        assert run(Path(f"/dev/fd/{ours}")).ok
    finally:
        os.close(ours)


def test_all_mistakes_of_all_files_come_at_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = written(tmp_path, "robots: [cyan1, cyan1]\nplaces: {cyan2: [0, 0, 0]}\n")
    monkeypatch.setattr("sys.argv", ["scenarios", "match-ends", str(bad), "no-such"])
    assert command.main() == 2
    printed = capsys.readouterr()
    assert printed.out == ""
    assert [line.count("mine.yaml") for line in printed.err.splitlines()] == [1, 1, 1, 0]


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
    with pytest.raises(ScenarioError, match=re.escape(f"{path}:2: '{text}': {message}")):
        read(path)


@pytest.mark.parametrize("text", ['state("offside")', "world.game_state.goals", "cyan9.role.value", "2 ** 10 ** 10"])
def test_condition_that_cannot_be_judged_is_a_mistake(tmp_path: Path, text: str) -> None:
    with pytest.raises(ScenarioError, match=r"mine.yaml:2: '.*': "):
        read(written(tmp_path, f"dummies: [cyan2]\nalways: ['{text}']\n"))


@pytest.mark.timeout(20)
def test_long_name_is_refused_at_once(tmp_path: Path) -> None:
    """A match waits while its crew reads a file."""
    with pytest.raises(ScenarioError, match=r"mine.yaml:1: robots.0: 'a1{20}.*' is not a name"):
        read(written(tmp_path, f"robots: [a{'1' * 90_000}ö]\nat_end: [ball_speed < 1]\n"))
