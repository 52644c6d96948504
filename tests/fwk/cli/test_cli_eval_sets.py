"""Settings of `fwk eval`: those that mean the same are one campaign, and each run has those of its campaign."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from fwk import Component, Config
from fwk.plan.load import load_plan
from fwk.testing.differing import digests_of
from fwk.testing.evaluation import Evaluation
from fwk.testing.executors import CampaignError
from fwk.testing.launched import system_of
from tests.fwk.cli.cli_eval_tools import LAUNCH, evaluated


class TunedConfig(Config):
    """Settings of two types."""

    gain: float = 0.5
    on: bool = True


class Tuned(Component):
    """Has settings."""

    stage = "act"
    config: TunedConfig

    def loop(self) -> None:
        """Ends at once."""


def gain(file: str, time_s: float, seed: int, sets: Sequence[str] = ()) -> float:
    """Returns the gain of the component that plays."""
    component: Any = system_of(file, seed=seed, sets=sets).runners["it/idle"].component
    return float(component.config.gain)


TUNED = LAUNCH.replace("cli_eval_parts:Idle", "test_cli_eval_sets:Tuned")


@pytest.mark.parametrize(
    ("typed", "again"),
    [
        (["it/idle.on=no"], ["it/idle.on=false"]),
        (["it/idle.gain=1.0"], ["it/idle.gain=1"]),
        (["it/idle.gain=2"], ["it/idle.gain= '2.0' "]),
        (["it/idle.gain=2"], ["it/idle.gain=3", "*/idle.gain=2"]),
        (["it/idle.gain=0.5"], []),
        (["loop_time_warnings=no", "it/idle.gain=2"], ["it/idle.gain=2", "loop_time_warnings=false"]),
    ],
)
def test_settings_typed_in_another_way_are_the_same(launch: Path, typed: list[str], again: list[str]) -> None:
    launch.write_text(TUNED)
    for seeds, sets in (("1", typed), ("1..2", again)):
        words = [word for text in sets for word in ("--set", text)]
        assert evaluated("it.yaml", "--seeds", seeds, "--jobs", "1", *words)[0] == 0


@pytest.mark.parametrize(
    ("typed", "again", "said"),
    [
        ("it/idle.gain=2", "it/idle.gain=2.1", "--set is it/idle.gain=2 there, it/idle.gain=2.1 here"),
        ("stage_time_s=1", "stage_time_s=2", "--set is stage_time_s=1 there, stage_time_s=2 here"),
    ],
)
def test_other_settings_are_another_campaign(launch: Path, typed: str, again: str, said: str) -> None:
    launch.write_text(TUNED)
    assert evaluated("it.yaml", "--seeds", "1", "--jobs", "1", "--set", typed)[0] == 0
    cure = "choose another folder"
    assert evaluated("it.yaml", "--set", again)[2] == f"error: eval-it holds another campaign: {said}; {cure}\n"


def test_note_of_former_code_compares_settings_as_typed(launch: Path) -> None:
    launch.write_text(TUNED)
    words = ("it.yaml", "--seeds", "1", "--jobs", "1", "--set")
    assert evaluated(*words, "it/idle.gain=2")[0] == 0
    note = launch.parent / "eval-it" / "campaign.json"
    note.write_text(json.dumps({key: value for key, value in json.loads(note.read_text()).items() if key != "run"}))
    assert evaluated(*words, "it/idle.gain=2")[0] == 0
    assert "--set is it/idle.gain=2 there, it/idle.gain=2.0 here" in evaluated(*words, "it/idle.gain=2.0")[2]


def test_worker_plays_a_launch_file_as_it_is_now(launch: Path) -> None:
    """A worker of a cluster lives longer than a campaign; the file may be changed between two, or during one."""
    evaluations = []
    for settings in ("{}", "{gain: 2.0}"):
        launch.write_text(f"{TUNED}\nconfig: {{it/idle: {settings}}}\n")
        use = f"{__name__}:gain"
        evaluations.append(Evaluation(use, plan=digests_of(load_plan(str(launch)))["plan"]))
        assert evaluations[-1](str(launch), 1.0, 1) == (2.0 if "gain" in settings else 0.5)
    with pytest.raises(CampaignError, match=r"it.yaml has other components or settings than at the start of the eval"):
        evaluations[0](str(launch), 1.0, 1)
    assert evaluations[1](str(launch), 1.0, 1) == 2.0
