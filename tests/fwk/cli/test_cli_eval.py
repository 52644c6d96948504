"""`fwk eval`: many seeded runs of a launch file, kept in a folder."""

import json
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fwk.cli.commands import app
from fwk.testing import campaign
from fwk.testing.campaign import Campaign, CampaignError, executor_of
from tests.fwk.cli.cli_eval_parts import measured

LAUNCH = """
name: it
evaluation: tests.fwk.cli.cli_eval_parts:measured
components:
  it/idle: {use: tests.fwk.cli.cli_eval_parts:Idle}
"""


@pytest.fixture
def launch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "it.yaml"
    file.write_text(LAUNCH)
    return file


def evaluated(*words: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["eval", *words])
    return result.exit_code, result.stdout, result.stderr


def test_each_seed_is_measured_and_reported(launch: Path) -> None:
    assert evaluated(str(launch), "--seeds", "1..3", "--time", "2", "--jobs", "1")[:2] == (0, "1 2 3\n")
    kept = json.loads((launch.parent / "eval-it" / "seed-2.json").read_text())
    assert kept == {"time_s": 2.0, "seed": 2}
    assert (launch.parent / "eval-it" / "seeds.txt").read_text() == "1 2 3"


def test_interrupted_evaluation_goes_on(launch: Path) -> None:
    result = CliRunner().invoke(app, ["eval", str(launch), "--seeds", "12..13", "--jobs", "1"])
    assert isinstance(result.exception, ValueError)
    kept = launch.parent / "eval-it" / "seed-12.json"
    kept.write_text(kept.read_text().replace("12", "120"))  # it is not played again
    assert evaluated(str(launch), "--seeds", "12", "--jobs", "1")[:2] == (0, "120\n")


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--seeds", "3..1"), "'3..1' is not a range of seeds; use 1..20, or 7"),
        (("--seeds", "x"), "'x' is not a range of seeds"),
        (("--time", "soon"), "'soon'"),
    ],
)
def test_bad_input(launch: Path, words: tuple[str, ...], message: str) -> None:
    code, _, said = evaluated(str(launch), *words)
    assert code == 2
    assert message in said.replace("\n", " ")


def test_launch_file_without_an_evaluation_is_refused(launch: Path) -> None:
    launch.write_text(LAUNCH.replace("evaluation: tests.fwk.cli.cli_eval_parts:measured\n", ""))
    code, _, said = evaluated(str(launch))
    assert (code, "names no 'evaluation: module:function'" in said.replace("\n", " ")) == (2, True)


def test_folder_of_another_campaign_is_refused(launch: Path) -> None:
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1")[0] == 0
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--time", "3")
    assert code == 1
    assert "holds another campaign" in said


def test_results_stay_when_a_later_run_fails(tmp_path: Path) -> None:
    first = Campaign(tmp_path, {"file": "it"})
    with ThreadPoolExecutor(1) as executor, pytest.raises(ValueError, match="an unlucky seed"):
        list(first.play(measured, "it", 1.0, [11, 12, 13], executor))
    again = Campaign(tmp_path, {"file": "it"})
    assert again.missing([11, 12, 13, 14]) == [13, 14]
    assert [result["seed"] for result in again.results([11, 12, 13])] == [11, 12]
    with ThreadPoolExecutor(1) as executor:
        assert list(again.play(measured, "it", 1.0, [11, 12, 14], executor)) == [14]


def test_without_dask_the_command_names_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    with pytest.raises(CampaignError, match=f"not installed: {campaign.INSTALL}"), executor_of(1, "tcp://127.0.0.1:9"):
        pass
