"""The commands that tests fork behave as those that the scripts of the environment start."""

import os
import signal
import subprocess
from pathlib import Path

import pytest

from tests.harness import commands
from tests.harness.commands import BIN
from tests.harness.fixtures import Launch
from tests.harness.runs import TIMEOUT_S, PortBlock, fwk
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system


def really(command: list[str], folder: Path, environment: dict[str, str]) -> "subprocess.CompletedProcess[str]":
    """Runs a command by its script."""
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)


@pytest.mark.parametrize(
    ("words", "code"),
    [
        ("fwk --version", 0),
        ("fwk runs list", 0),
        ("fwk check small.yaml", 0),
        ("fwk check none.yaml", 2),
        ("fwk replay none.lcm", 2),
        ("fwk-launch small.yaml --tiks 3", 2),
    ],
)
def test_a_forked_command_ends_and_prints_as_its_script(
    tmp_path: Path, ports: PortBlock, words: str, code: int
) -> None:
    write_system(tmp_path, ports)
    name, *rest = words.split()
    command, environment = [str(BIN / name), *rest], {**os.environ, "HOME": str(tmp_path)}
    forked, real = commands.run(command, tmp_path, environment, TIMEOUT_S), really(command, tmp_path, environment)
    assert (forked.returncode, forked.stdout, forked.stderr) == (real.returncode, real.stdout, real.stderr)
    assert forked.returncode == code


def test_a_signal_ends_a_forked_run_and_shows_in_its_code(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    write_system(tmp_path, ports)
    run = launch("small.yaml")
    Steered(run, ports)
    assert isinstance(run.process, commands.Command)
    assert len(run.processes()) >= 4
    assert os.getsid(run.process.pid) == run.process.pid
    with pytest.raises(subprocess.TimeoutExpired):
        run.wait(0.0)
    run.signal(signal.SIGKILL)
    assert run.wait() == -signal.SIGKILL
    assert run.gone_within(TIMEOUT_S)


def test_each_of_two_runs_and_a_command_has_its_own_hash_seed(tmp_path: Path, ports: PortBlock, launch: Launch) -> None:
    """A result that depends on the order of a set differs between two runs, and between a run and its replay."""
    write_system(tmp_path, ports)
    code = tmp_path / "small.py"
    code.write_text(code.read_text() + "\nprint('hash', hash('fwk'))\n")
    texts = [fwk(tmp_path, "check", "small.yaml")]
    for _ in range(2):
        run = launch("small.yaml", "--ticks", "1")
        assert run.wait() == 0, run.text
        texts.append(run.text)
    assert len({line for text in texts for line in text.splitlines() if line.startswith("hash ")}) == 3


def test_a_library_that_reads_a_variable_at_its_import_sees_it(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONVERBOSE": "1"}
    assert "import 'fwk'" in commands.run([str(BIN / "fwk"), "--version"], tmp_path, environment, TIMEOUT_S).stderr
