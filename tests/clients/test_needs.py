"""Tests that lack a program are skipped, and the end of the test run lists them."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TESTS = """
def test_lacks_something(needs):
    needs("sh", "no-such-program", "Xvfb-of-the-future")
    assert False

def test_has_everything(needs):
    needs("sh")
"""


@pytest.mark.slow
@pytest.mark.parametrize("workers", [[], ["--numprocesses", "1"]], ids=["serial", "parallel"])
def test_a_test_without_its_program_is_skipped_and_listed(tmp_path: Path, workers: list[str]) -> None:
    shutil.copy(Path(__file__).parents[1] / "conftest.py", tmp_path)
    (tmp_path / "test_it.py").write_text(TESTS)
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "--rootdir",
        str(tmp_path),
        *workers,
        str(tmp_path),
    ]
    result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert result.returncode == 0
    assert "1 passed, 1 skipped" in result.stdout
    reason = "needs no-such-program, Xvfb-of-the-future: apt install no-such-program Xvfb-of-the-future"
    lines = result.stdout.splitlines()
    place = next(number for number, line in enumerate(lines) if f"left out, {reason}" in line)
    assert lines[place + 1] == "test_it.py::test_lacks_something"
