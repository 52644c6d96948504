"""Words of the measurements' command lines."""

import subprocess
import sys

import pytest

from tools.bench.idle import words_of_run


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("components nofile.yaml", "error: nofile.yaml: no such launch file"),
        ("processes nofile.yaml", "error: nofile.yaml: no such launch file"),
        ("console --launch nofile.yaml", "error: nofile.yaml: no such launch file"),
        ("processes soccer-truth.yaml --hosting both", "--hosting"),
        ("physics --seconds 0", "--seconds"),
        ("physics --seconds nan", "--seconds"),
        ("physics --rounds 0", "--rounds"),
        ("filters --ticks 0", "--ticks"),
        ("__main__ --sizes 0", "'0': numbers from 1, separated by commas"),
        ("__main__ --render --json nowhere.json", "No such file"),
        ("install nothing", "error: no environment 'nothing'; there are core, zmq"),
    ],
)
def test_bad_words_end_a_measurement_with_a_sentence(words: str, said: str) -> None:
    module, *rest = words.split()
    ended = subprocess.run(
        [sys.executable, "-m", f"tools.bench.{module}", *rest], capture_output=True, text=True, timeout=60, check=False
    )
    assert ended.returncode == 2
    assert said in ended.stderr
    assert "Traceback" not in ended.stderr


@pytest.mark.parametrize(
    ("given", "added"),
    [
        ("soccer.yaml", "--ticks 400 --speed max"),
        ("soccer.yaml --ticks=5", "--speed max"),
        ("soccer.yaml --time 3 --speed 1", ""),
    ],
)
def test_idle_runs_end_by_themselves(given: str, added: str) -> None:
    assert words_of_run(given.split()) == [*given.split(), *added.split()]
