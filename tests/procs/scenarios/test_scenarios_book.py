"""All scenarios of the book succeed, and their runner says what goes wrong."""

from pathlib import Path

import pytest

from fwk.testing import ExpressionError
from procs.scenarios import __main__ as command
from procs.scenarios.scenario import BOOK, ScenarioError, read, run

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
        ("robot: [cyan2]", ScenarioError, "mine.yaml"),
        ("robots: [", ScenarioError, "mine.yaml"),
        ("eventually: ['x(ball']", ExpressionError, "never closed"),
        ("dummies: [cyan2]\neventually: [x(cyan3) > 0]", ExpressionError, "no robot 'cyan3'"),
        ("dummies: [cyan2]\neventually: [world.game.score > 0]", ExpressionError, "world/game"),
    ],
)
def test_bad_scenario_is_named(tmp_path: Path, text: str, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        run(written(tmp_path, text))


def test_command_prints_a_line_for_each_scenario(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    bad = written(tmp_path, "dummies: [cyan2]\nalways: [world.game_state.score_cyan > 0]\ntime_s: 0.2\n")
    monkeypatch.setattr("sys.argv", ["scenarios", "match-ends", str(bad)])
    assert command.main() == 1
    printed = capsys.readouterr().out.splitlines()
    assert printed[0].startswith("ok     match-ends (")
    assert printed[1:] == ["failed mine (0.1 s)", "       0.05 s: not world.game_state.score_cyan > 0"]
