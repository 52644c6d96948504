"""`fwk eval`: many seeded runs of a launch file, kept in a folder."""

import json
import math
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Timer
from typing import Any

import psutil
import pytest

from fwk.cli.recordings import evaluate
from fwk.testing.campaign import Campaign
from fwk.testing.executors import CampaignError
from fwk.testing.results import FolderError
from tests.fwk.cli import cli_eval_parts
from tests.fwk.cli.cli_eval_parts import measured
from tests.fwk.cli.cli_eval_tools import LAUNCH, Queue, evaluated


def test_each_seed_is_measured_and_reported(launch: Path) -> None:
    assert evaluated(str(launch), "--seeds", "1..3", "--time", "2", "--jobs", "1")[:2] == (0, "1 2 3\n")
    kept = json.loads((launch.parent / "eval-it" / "seed-2.json").read_text())
    assert (kept["time_s"], kept["seed"]) == (2.0, 2)
    assert (launch.parent / "eval-it" / "seeds.txt").read_text() == "1 2 3"


def test_report_gets_the_seed_of_each_result(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli_eval_parts, "report", lambda results, folder, seeds: f"{len(results)} of {seeds}")
    assert evaluated(str(launch), "--seeds", "12..14", "--jobs", "1")[:2] == (1, "2 of [12, 14]\n")


def test_interrupted_evaluation_resumes(launch: Path) -> None:
    code, table, said = evaluated(str(launch), "--seeds", "12..14", "--jobs", "1")
    assert (code, table) == (1, "12 14\n")
    assert "error: 1 of 3 runs failed: seed 13: ValueError: an unlucky seed" in said
    kept = launch.parent / "eval-it" / "seed-12.json"
    kept.write_text(kept.read_text().replace("12", "120"))  # it is not played again
    assert evaluated(str(launch), "--seeds", "12", "--jobs", "1")[:2] == (0, "120\n")


def test_no_more_processes_than_missing_runs(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []

    def counted(jobs: int, cluster: str, limit_s: float | None) -> Any:
        asked.append(jobs)
        return ThreadPoolExecutor(jobs)

    monkeypatch.setattr(evaluate, "executor_of", counted)
    for seeds, jobs in (("1..2", "99999"), ("1..3", "400"), ("1..3", "400"), ("1..9", "4")):
        assert evaluated(str(launch), "--seeds", seeds, "--jobs", jobs)[0] == 0
    assert asked == [2, 1, 4]


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--seeds", "3..1"), "'3..1' is not a range of seeds; use 1..20, or 7"),
        (("--seeds", "x"), "'x' is not a range of seeds"),
        (("--seeds", "1_0"), "'1_0' is not a range of seeds"),
        (("--seeds", "1..100001"), "'1..100001' is too many; use 100,000 seeds at most"),
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
    assert code == 2
    assert "eval-it holds another campaign: --time is 25 there, 3 here; choose another folder" in said


def test_folder_knows_its_launch_file_by_other_paths(launch: Path) -> None:
    assert evaluated("it.yaml", "--seeds", "1", "--jobs", "1")[0] == 0
    (launch.parent / "beside").mkdir()
    assert evaluated("beside/../it.yaml", "--seeds", "1", "--jobs", "1")[:2] == (0, "1\n")


def test_folder_without_results_takes_another_campaign(launch: Path) -> None:
    """The only run of a mistaken command failed; the right command needs no other folder."""
    assert evaluated(str(launch), "--seeds", "13", "--jobs", "1", "--time", "0.001")[0] == 1
    with Campaign(launch.parent / "other", {"file": "another"}).alone():
        code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--out", "other")
        assert (code, "holds another campaign" in said) == (2, True), "it is being played"
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--time", "3")[:2] == (0, "1\n")
    note = json.loads((launch.parent / "eval-it" / "campaign.json").read_text())
    assert note["time_s"] == 3.0


def test_changed_launch_file_is_another_campaign(launch: Path) -> None:
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1")[0] == 0
    launch.write_text("# The same system.\n" + LAUNCH)
    assert evaluated(str(launch), "--seeds", "1..2", "--jobs", "1")[:2] == (0, "1 2\n")
    staged = LAUNCH.replace("Idle}", "Idle, stage: think}")
    for changed in (f"{LAUNCH}period_s: 0.1\n", f"{LAUNCH}stages: [think, act]\n", staged):
        launch.write_text(changed)
        code, _, said = evaluated(str(launch), "--seeds", "1..3", "--jobs", "1")
        assert (code, "another campaign: its launch file had other components or settings" in said) == (2, True)


def test_folder_that_cannot_be_is_named(launch: Path) -> None:
    code, _, said = evaluated(str(launch), "--seeds", "1", "--out", str(launch))
    assert (code, said) == (2, f"error: --out {launch}: it is not a folder; name one for the results\n")


def test_overridden_settings_reach_each_run(launch: Path) -> None:
    words = (str(launch), "--seeds", "1", "--jobs", "1")
    assert evaluated(*words, "--set", "period_s=0.1")[0] == 0
    assert json.loads((launch.parent / "eval-it" / "seed-1.json").read_text())["sets"] == ["period_s=0.1"]
    code, _, said = evaluated(*words)
    assert (code, "another campaign: --set is period_s=0.1 there, none here" in said) == (2, True)


def test_order_of_overridden_settings_makes_no_difference(launch: Path) -> None:
    words, (one, two) = (str(launch), "--jobs", "1", "--seeds"), ("period_s=0.1", "stage_time_s=1")
    assert evaluated(*words, "1", "--set", one, "--set", two)[0] == 0
    assert evaluated(*words, "1..2", "--set", two, "--set", one)[0] == 0
    code, _, said = evaluated(*words, "1..2", "--set", one)
    assert (code, "another campaign: --set is" in said) == (2, True)


def test_mistake_in_an_overridden_setting_is_named(launch: Path) -> None:
    code, _, said = evaluated(str(launch), "--set", "it/idle.speed=1")
    assert (code, "it/idle" in said, "speed" in said) == (2, True, True)


def test_evaluation_that_takes_no_settings_refuses_them(launch: Path) -> None:
    launch.write_text(LAUNCH.replace("parts:measured", "parts:without_settings"))
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1")[0] == 0
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--set", "period_s=0.1", "-o", "other")
    assert (code, "without_settings takes no settings; leave out --set, or give it a fourth" in said) == (2, True)
    assert not (launch.parent / "other").exists()


def test_evaluation_with_a_time_of_its_own_refuses_time(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli_eval_parts, "OWN_TIME", True, raising=False)
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--time", "25")
    assert (code, "parts:measured plays each run for a time of its own; leave out --time" in said) == (2, True)
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1")[:2] == (0, "1\n")


def test_seed_in_an_overridden_setting_is_refused(launch: Path) -> None:
    code, _, said = evaluated(str(launch), "--seeds", "1", "--set", "seed=5")
    assert (code, "--set seed changes no run, because each has a seed of --seeds; leave it out" in said) == (2, True)


def test_evaluation_without_a_report_is_refused(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(cli_eval_parts, "report")
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1")
    assert (code, "cli_eval_parts has no function 'report', which makes the table; give it" in said) == (2, True)
    assert not (launch.parent / "eval-it").exists()


@pytest.mark.parametrize("name", ["", " "])
def test_folder_without_a_name_is_refused(launch: Path, name: str) -> None:
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1", "--out", name)
    assert (code, f"'{name}' names no folder; leave out --out" in said.replace("\n", " ")) == (2, True)
    assert list(launch.parent.iterdir()) == [launch]


DAMAGES = [b"", b'{"seed": 1', b"{}", b"\xff\xfe\x00", b"[" * 99_999]


@pytest.mark.parametrize("content", DAMAGES, ids=["empty", "truncated", "says nothing", "garbage", "deep"])
def test_damaged_result_is_named_and_played_again(launch: Path, content: bytes) -> None:
    words = (str(launch), "--seeds", "1..3", "--jobs", "1")
    assert evaluated(*words)[0] == 0
    damaged = launch.parent / "eval-it" / "seed-2.json"
    damaged.write_bytes(content)
    code, table, said = evaluated(*words)
    assert (code, table) == (0, "1 2 3\n")
    assert f"note: {Path('eval-it/seed-2.json')} is damaged: it " in said
    assert "; its seed is played again\n" in said
    assert json.loads(damaged.read_text())["seed"] == 2
    assert "damaged" not in evaluated(*words)[2]


def _flaw_in(result: Any) -> str:
    return "" if isinstance(result, dict) and "seed" in result else "it has no seed"


@pytest.mark.parametrize("content", ["[1]", '{"a": 1}', "null"])
def test_result_of_another_shape_is_played_again(launch: Path, monkeypatch: pytest.MonkeyPatch, content: str) -> None:
    monkeypatch.setattr(cli_eval_parts, "flaw_in", _flaw_in, raising=False)
    words = (str(launch), "--seeds", "1..3", "--jobs", "1")
    assert evaluated(*words)[0] == 0
    damaged = launch.parent / "eval-it" / "seed-2.json"
    damaged.write_text(content)
    code, table, said = evaluated(*words)
    assert (code, table) == (0, "1 2 3\n")
    assert "note: eval-it/seed-2.json is damaged: it has no seed; its seed is played again\n" in said
    assert json.loads(damaged.read_text())["seed"] == 2


def test_result_that_its_evaluation_refuses_fails(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli_eval_parts, "flaw_in", lambda result: "it is odd" * (result["seed"] == 2), raising=False)
    code, table, said = evaluated(str(launch), "--seeds", "2..3", "--jobs", "1")
    assert (code, table) == (1, "3\n")
    assert "seed 2: the evaluation returned a result that is not one: it is odd" in said


def test_damaged_result_whose_run_fails_is_not_reported(launch: Path) -> None:
    assert evaluated(str(launch), "--seeds", "12", "--jobs", "1")[0] == 0
    (launch.parent / "eval-it" / "seed-13.json").write_text("{")
    code, table, said = evaluated(str(launch), "--seeds", "12..13", "--jobs", "1")
    assert (code, table) == (1, "12\n")
    assert "error: 1 of 1 runs failed: seed 13: ValueError: an unlucky seed" in said


@pytest.mark.parametrize("content", [*DAMAGES, b"null", b'"x"', b"[1]"])
def test_damaged_note_of_a_campaign_is_named(launch: Path, content: bytes) -> None:
    words = (str(launch), "--seeds", "1", "--jobs", "1")
    assert evaluated(*words)[0] == 0
    (launch.parent / "eval-it" / "campaign.json").write_bytes(content)
    code, _, said = evaluated(*words)
    assert (code, "error: eval-it/campaign.json is damaged: it " in said) == (2, True)
    assert said.endswith("this launch file and its settings, or choose another folder\n")


@pytest.mark.parametrize("name", ["campaign.json", "seed-1.json", "seeds.txt"])
def test_folder_in_the_place_of_a_file_is_named(launch: Path, name: str) -> None:
    (launch.parent / "eval-it" / name).mkdir(parents=True)
    code, _, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1")
    assert (code, f"eval-it/{name}" in said, "Is a directory" in said) == (2, True, True)


@pytest.mark.parametrize("files", [["code.json"], ["code.json", "seed-1.json"]])
def test_result_that_cannot_be_written_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, files: list[str]
) -> None:
    *written, name = files
    left = [None] * len(written)

    def fail(_: int) -> None:
        if not left:
            raise OSError(28, "No space left on device")
        left.pop()

    campaign = Campaign(tmp_path, {"file": "it"})
    monkeypatch.setattr("os.fsync", fail)
    with ThreadPoolExecutor(1) as executor, pytest.raises(FolderError, match=f"/{name} cannot be written: No space"):
        list(campaign.play(measured, "it", 1.0, [1], executor))
    assert sorted(file.name for file in tmp_path.iterdir()) == ["campaign.json", *written]


@pytest.mark.parametrize(("result", "cause"), [({}, "which has no measurements"), ({1j}, "not JSON serializable")])
def test_result_that_cannot_be_kept_fails_its_run(tmp_path: Path, result: Any, cause: str) -> None:
    campaign = Campaign(tmp_path, {"file": "it"})
    with ThreadPoolExecutor(1) as executor, pytest.raises(CampaignError, match=f"seed 1: .*{cause}"):
        list(campaign.play(lambda *_: result, "it", 1.0, [1], executor))
    assert campaign.missing([1]) == [1]


def test_results_are_plain_json(tmp_path: Path) -> None:
    """Programs in other languages read them, too; infinite values stay."""
    result = {"a": [math.inf, -math.inf, 1.5], "b": math.nan, 'NaN "Infinity': "-Infinity \\"}
    campaign = Campaign(tmp_path, {"file": "it"})
    with ThreadPoolExecutor(1) as executor:
        list(campaign.play(lambda *_: result, "it", 1.0, [1], executor))

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    kept = json.loads((tmp_path / "seed-1.json").read_text(), parse_constant=refuse)
    assert kept == result | {"b": None}
    assert list(campaign.results([1])) == [kept]


def test_results_stay_when_another_run_fails(tmp_path: Path) -> None:
    first = Campaign(tmp_path, {"file": "it"})
    with (
        ThreadPoolExecutor(1) as executor,
        pytest.raises(CampaignError, match="1 of 3 runs failed: seed 13: ValueError"),
    ):
        list(first.play(measured, "it", 1.0, [11, 13, 12], executor))
    again = Campaign(tmp_path, {"file": "it"})
    assert again.missing([11, 12, 13, 14]) == [13, 14]
    assert [result["seed"] for result in again.results([11, 12, 13])] == [11, 12]
    with ThreadPoolExecutor(1) as executor:
        assert list(again.play(measured, "it", 1.0, [11, 12, 14], executor)) == [14]


def test_results_are_read_one_at_a_time(tmp_path: Path) -> None:
    """A hundred matches together would need gigabytes."""
    campaign = Campaign(tmp_path, {"file": "it"})
    for seed in (1, 2, 3):
        (tmp_path / f"seed-{seed}.json").write_text(f'{{"seed": {seed}}}')
    results = campaign.results(range(1, 9))
    (tmp_path / "seed-2.json").write_text('{"seed": "read late"}')
    assert [result["seed"] for result in results] == [1, "read late", 3]
    assert (len(results), results[-1]["seed"], [each["seed"] for each in results[1:]]) == (3, 3, ["read late", 3])
    assert not campaign.results(range(4, 9))


def test_early_stop_cancels_runs_that_did_not_begin(tmp_path: Path) -> None:
    begun: list[int] = []
    executor = Queue()
    runs = Campaign(tmp_path, {"file": "it"}).play(lambda *words: begun.append(words[2]), "it", 1.0, range(5), executor)
    late = Timer(5.0, executor.give_up)  # otherwise this test would wait for ever after a first run without a result
    late.start()
    try:
        assert next(runs) == 0
    finally:
        late.cancel()
    runs.close()
    assert (begun, [each.cancelled() for each in executor.futures]) == ([0], [False, True, True, True, True])


@pytest.mark.parametrize(
    ("seed", "cause"), [(66, "its process died; perhaps a program killed it"), (77, "SystemExit: no more")]
)
def test_run_that_ends_its_process_fails_alone(launch: Path, seed: int, cause: str) -> None:
    code, table, said = evaluated(str(launch), "--seeds", f"{seed - 2}..{seed + 5}", "--jobs", "2")
    assert (code, table) == (1, " ".join(str(each) for each in range(seed - 2, seed + 6) if each != seed) + "\n")
    assert f"error: 1 of 8 runs failed: seed {seed}: {cause}" in said


def test_run_that_hangs_fails_alone_at_its_limit(launch: Path) -> None:
    words = (str(launch), "--seeds", "87..91", "--jobs", "2", "--limit", "2")
    code, table, said = evaluated(*words)
    assert (code, table) == (1, "87 89 90 91\n")
    assert "error: 1 of 5 runs failed: seed 88: it took longer than --limit, 2 s, and was ended" in said
    assert not [each for each in psutil.Process().children() if each.status() == psutil.STATUS_RUNNING]


@pytest.mark.parametrize(
    ("option", "cause"),
    [
        ("--limit", "nothing ends runs on a cluster"),
        ("--jobs", "the workers of a cluster play as many runs as they have threads"),
    ],
)
def test_bounds_of_runs_on_a_cluster_are_refused(launch: Path, option: str, cause: str) -> None:
    code, _, said = evaluated(str(launch), option, "2", "--cluster", "tcp://127.0.0.1:9")
    assert (code, said) == (2, f"error: {cause}; leave out {option}, or --cluster\n")


def test_file_gets_a_line_for_each_run(launch: Path) -> None:
    said = evaluated(str(launch), "--seeds", "4..5", "--jobs", "1")[2]
    assert said.splitlines() == ["playing 2 of 2 runs", "1 of 2: seed 4", "2 of 2: seed 5"]


def test_failures_of_one_cause_are_told_together(tmp_path: Path) -> None:
    def fails(file: str, time_s: float, seed: int) -> Any:
        raise ValueError("an unlucky\nseed " * (99 if seed == 20 else 1))

    told = "seeds 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 2 more: ValueError: an unlucky seed; seed 20: ValueError: an unlu"
    with ThreadPoolExecutor(1) as executor, pytest.raises(CampaignError, match=re.escape(told)) as raised:
        list(Campaign(tmp_path, {}).play(fails, "it", 1.0, [*range(1, 13), 20], executor))
    assert str(raised.value).endswith(" ...")
    assert len(str(raised.value)) < 500


def test_two_evaluations_do_not_share_a_folder(launch: Path) -> None:
    with Campaign(launch.parent / "eval-it", {}).alone():
        (launch.parent / "eval-it" / "campaign.json").unlink()
        code, table, said = evaluated(str(launch), "--seeds", "1", "--jobs", "1")
        assert (code, table) == (1, "")
        assert "error: another evaluation is playing into eval-it; wait until it has ended, or" in said
    assert evaluated(str(launch), "--seeds", "1", "--jobs", "1")[0] == 0
