"""`fwk eval` whose components fail: the message names the component, the error and its place."""

import re
from pathlib import Path

import pytest

from fwk import Clock, Component
from fwk.testing import MemorySystem
from tests.fwk.cli.cli_eval_parts import Idle
from tests.fwk.cli.cli_eval_tools import LAUNCH, evaluated


class UnpicklableError(Exception):
    """An error that no other process can make again."""

    def __init__(self, first: str, second: str) -> None:
        super().__init__(f"{first} {second}")


class Crash(Component):
    """Fails in its second iteration."""

    stage = "act"
    clock: Clock

    def loop(self) -> None:
        if self.clock.tick == 2:
            raise UnpicklableError("no", "way")


class Leave(Component):
    """Ends the program."""

    stage = "act"

    def loop(self) -> None:
        raise SystemExit(0)


def measured(file: str, time_s: float, seed: int) -> None:
    """Runs the components, of which one fails."""
    MemorySystem({"it/well": Idle, "it/crash": Crash}).tick(2)


def left(file: str, time_s: float, seed: int) -> None:
    """Runs the components, of which one ends the program."""
    MemorySystem({"it/well": Idle, "it/leave": Leave}).tick(2)


def report(results: object, folder: Path) -> str:
    """Returns no table."""
    return ""


@pytest.mark.parametrize(
    ("work", "error"), [("measured", "it/crash: UnpicklableError: no way"), ("left", "it/leave: SystemExit: 0")]
)
def test_failed_component_and_its_place_are_named(launch: Path, work: str, error: str) -> None:
    launch.write_text(LAUNCH.replace("cli_eval_parts:measured", f"test_cli_eval_failing:{work}"))
    code, _, said = evaluated(str(launch), "--seeds", "1..3", "--jobs", "2")
    cause = rf"seeds 1, 2, 3: {error} \(.*/test_cli_eval_failing\.py:\d+\)"
    assert (code, bool(re.search(f"error: 3 of 3 runs failed: {cause}\n", said))) == (1, True)


OWN = """
def measured(file, time_s, seed):
    return {"a": 1}
def report(results, folder):
    return "table"
"""


@pytest.mark.parametrize(
    ("module", "line", "code", "said"),
    [
        (
            "own_report",
            "def report(results, folder): raise ValueError('no')",
            1,
            r"error: own_report\.report failed: ValueError: no \(.*/own_report\.py:6\); the results .* in eval-it\n",
        ),
        (
            "own_flaw",
            "def flaw_in(result): raise KeyError('x')",
            1,
            r"error: own_flaw\.flaw_in failed: KeyError: 'x' \(.*/own_flaw\.py:6\)\n",
        ),
        (
            "own_pipe",
            "import os; INPUTS = [__file__.replace('own_pipe.py', 'pipe')]; os.mkfifo(*INPUTS)",
            2,
            "error: .*/pipe, one of the INPUTS of own_pipe, is no ordinary file\n",
        ),
        ("own_path", "INPUTS = ['gone.csv']", 2, "error: gone.csv, one of the INPUTS of own_path: No such file .*\n"),
    ],
)
def test_mistakes_of_the_evaluation_are_named(launch: Path, module: str, line: str, code: int, said: str) -> None:
    (launch.parent / f"{module}.py").write_text(f"{OWN}{line}\n")
    launch.write_text(LAUNCH.replace("tests.fwk.cli.cli_eval_parts:measured", f"{module}:measured"))
    ended, _, errors = evaluated(str(launch), "--seeds", "1")
    assert ended == code
    assert re.search(said, errors)
    assert "Traceback" not in errors
