"""Evaluation of a folder of scenarios with many seeds: what counts, and which mistakes end it."""

import json
import re
from pathlib import Path

import pytest

from procs.scenarios import evaluation
from procs.scenarios.file import ScenarioError
from tests.procs.scenarios.scenario_files import written


def test_evaluation_of_the_book_counts_seeds(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = "dummies: [cyan2]\nalways: [x(cyan2) < 0]\neventually: [world.game_state.header.tick > 5]\ntime_s: 0.3\n"
    written(tmp_path, text)
    (tmp_path / "bad.yaml").write_text("dummies: [cyan2]\nalways: [x(cyan2) > 0]\ntime_s: 0.3\n")
    monkeypatch.setattr(evaluation, "BOOK", tmp_path)
    results = [evaluation.played("scenarios.yaml", 0.1, seed) for seed in (1, 2)]  # no scenario is cut off
    assert results == [{"bad": ["0.05 s: not x(cyan2) > 0"], "mine": []}] * 2
    out = tmp_path / "out"
    out.mkdir()
    text = evaluation.report(results, out)
    rows = {row["name"]: row for row in json.loads((out / "table.json").read_text())}
    assert {name: row["value"] for name, row in rows.items()} == {evaluation.ALL: 0.5, "bad": 0.0, "mine": 1.0}
    assert text.endswith("\nbad: 0.05 s: not x(cyan2) > 0")
    assert evaluation.report(results, out, [3, 7]).endswith("\nbad, seeds 3, 7: 0.05 s: not x(cyan2) > 0")
    assert evaluation.report(results[:1], out, [3]).endswith("\nbad, seed 3: 0.05 s: not x(cyan2) > 0")
    assert sorted(file.name for file in out.iterdir()) == ["measures.png", "table.csv", "table.json"]


def test_evaluation_names_mistakes_before_it_plays(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(ScenarioError, match="there are no scenarios"):
        evaluation.played_in(tmp_path, 1)
    written(tmp_path, "dummies: [cyan2]\nalways: [x(cyan2) < 0]\ntime_s: 0.3\n")
    assert evaluation.played_in(tmp_path, 1) == {"mine": []}
    (tmp_path / "bad.yaml").write_text("robot: [cyan2]\n")
    (tmp_path / "worse.yaml").write_text("- cyan2\n")
    monkeypatch.setattr(evaluation, "outcome", pytest.fail)
    with pytest.raises(ScenarioError, match=r"bad.yaml:1: no key 'robot'; .*; .*worse.yaml:1: "):
        evaluation.played_in(tmp_path, 1)


def test_evaluation_names_a_mistake_that_the_run_shows(tmp_path: Path) -> None:
    path = written(tmp_path, "dummies: [cyan2]\nalways: [\"touching[0] == 'cyan2'\"]\ntime_s: 0.2\n")
    with pytest.raises(ScenarioError, match=re.escape(f"{path}:2: 'touching[0] == 'cyan2'': an index is beyond")):
        evaluation.played_in(tmp_path, 1)


@pytest.mark.parametrize("result", [[1], 3, {}, {"mine": 1}, {"mine": "never"}, {"mine": [1]}, {"mine": None}])
def test_result_that_is_none_of_scenarios_is_named(result: object) -> None:
    assert evaluation.flaw_in(result) == "it should hold a list of texts for each scenario"
    assert evaluation.flaw_in({"mine": [], "bad": ["never: x(ball) > 1"]}) == ""
