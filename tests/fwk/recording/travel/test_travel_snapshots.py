"""Snapshots: a process goes back again and again, also past snapshots that have ended, and all end with it."""

import subprocess
import sys

import psutil
import pytest

pytestmark = pytest.mark.system

MODULE = "tests.fwk.recording.travel.wanderer"


def wandered(*numbers: int) -> tuple[int, list[int]]:
    """Returns the exit code, and where the fronts began; no process is left."""
    words = [sys.executable, "-m", MODULE, *map(str, numbers)]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=False)
    assert done.stderr == ""
    _, alive = psutil.wait_procs(
        [each for each in psutil.process_iter() if MODULE in " ".join(_words(each))], timeout=10
    )
    assert alive == []
    return done.returncode, [int(line.removeprefix("from ")) for line in done.stdout.splitlines()]


def _words(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:
        return []


def test_a_process_goes_back_again_and_again() -> None:
    code, began = wandered(59, 58, 55)
    assert began == [59, 58, 55]
    assert code == 55


def test_what_was_thinned_out_is_reached_from_an_older_snapshot() -> None:
    wanted = range(24, 2, -2)
    code, began = wandered(*wanted)
    assert len(began) == len(wanted)
    assert all(asked - 10 <= number <= asked for number, asked in zip(began, wanted, strict=True)), began
    assert began != [*wanted]
    assert code == began[-1]


def test_a_front_that_is_killed_ends_everything() -> None:
    assert wandered(50, 0) == (1, [50])
