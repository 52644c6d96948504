"""Results of `fwk eval` that are of other code than today's: they are kept and named."""

from pathlib import Path

import pytest

from fwk.cli.recordings import evaluate
from tests.fwk.cli import cli_eval_parts
from tests.fwk.cli.cli_eval_tools import LAUNCH, evaluated


def test_results_of_changed_input_files_are_named(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scene = launch.with_name("scene.yaml")
    scene.write_text("ball: 1")
    monkeypatch.setattr(cli_eval_parts, "INPUTS", [scene], raising=False)
    words = (str(launch), "--jobs", "1", "--seeds", "1")
    assert "former code" not in evaluated(*words)[2]
    assert "former code" not in evaluated(*words)[2]
    scene.write_text("ball: 2")
    assert "note: the result of seed 1 is of former code;" in evaluated(*words)[2]


def test_results_of_former_code_are_named(launch: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    words = (str(launch), "--jobs", "1", "--seeds")
    assert "former code" not in evaluated(*words, "1..2")[2]
    monkeypatch.setattr(evaluate, "_modules", lambda plan: {"it": "changed"})
    code, table, said = evaluated(*words, "1..3")
    assert (code, table) == (0, "1 2 3\n")
    cure = "remove their files from eval-it to play them again"
    assert f"note: 2 results are of former code, those of seeds 1, 2; {cure}\n" in said
    (launch.parent / "eval-it" / "seed-1.json").unlink()
    assert f"note: the result of seed 2 is of former code; {cure}\n" in evaluated(*words, "1..3")[2]
    assert "former code" not in evaluated(*words, "1")[2]


def test_results_of_changed_programs_are_named(launch: Path) -> None:
    """A component may be a program, which no module tells."""
    program = launch.with_name("adder.py")
    program.write_text("print('old')\n")
    launch.write_text(f"{LAUNCH}  it/adder: {{command: [python3, ./adder.py], writes: {{imu: robot.imu_t}}}}\n")
    words = (str(launch), "--jobs", "1", "--seeds", "1")
    assert "former code" not in evaluated(*words)[2]
    assert "former code" not in evaluated(*words)[2]
    program.write_text("print('new')\n")
    assert "note: the result of seed 1 is of former code;" in evaluated(*words)[2]
