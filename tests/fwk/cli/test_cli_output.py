"""Commands end with a sentence when the machine fails them: closed or full outputs, no folder, no descriptors."""

import os
import resource
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from fwk.cli import launch
from tests.fwk.cli.cli_processes import PROCS, write_files
from tests.harness.runs import PortBlock

FWK = [sys.executable, "-m", "fwk.cli.main"]


def run(command: list[str], **options: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, stderr=subprocess.PIPE, text=True, check=False, **options)  # type: ignore[call-overload, no-any-return]


@pytest.mark.slow
@pytest.mark.parametrize("typed", [["--help"], ["ps", "--json"], ["check", "one-robot.yaml"]])
def test_a_full_disk_is_a_sentence(typed: list[str]) -> None:
    with open("/dev/full", "w") as full:
        done = run([*FWK, *typed], stdout=full)
    assert done.returncode == 2
    assert done.stderr == "error: the output cannot be written: No space left on device\n"


@pytest.mark.parametrize("typed", ["--help", "ps --json"])
def test_a_closed_output_is_no_traceback(typed: str) -> None:
    done = run(["sh", "-c", f'exec "$0" -m fwk.cli.main {typed} >&-', sys.executable])
    assert "Traceback" not in done.stderr


@pytest.mark.system
def test_a_run_needs_no_standard_stream(tmp_path: Path, ports: PortBlock) -> None:
    write_files(tmp_path, PROCS)
    arguments = f"cards.yaml --ticks 3 --speed max --no-record --bus-port {ports.bus}"
    script = f'"$0" -P -m fwk.cli.launch {arguments} <&- >&- 2>&-; echo "ended with $?"'
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3]), "HOME": str(tmp_path)}
    done = run(["sh", "-c", script, sys.executable], stdout=subprocess.PIPE, cwd=tmp_path, env=environment)
    assert done.stdout == "ended with 0\n"


def test_a_reader_that_closes_early_ends_it_quietly() -> None:
    read, write = os.pipe()
    os.close(read)
    done = run([*FWK, "--help"], stdout=write)
    os.close(write)
    assert (done.returncode, done.stderr) == (1, "")


@pytest.mark.parametrize("module", ["fwk.cli.main", "fwk.cli.launch"])
def test_a_deleted_folder_is_named(tmp_path: Path, module: str) -> None:
    (tmp_path / "gone").mkdir()
    script = f'rmdir ../gone; exec "$0" -P -m {module} --version'
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parents[3])}
    done = run(["sh", "-c", script, sys.executable], cwd=tmp_path / "gone", env=environment)
    assert done.returncode == 2
    assert done.stderr.startswith("error: the current folder does not exist any more")


@pytest.mark.slow
def test_a_run_with_few_descriptors_is_refused(tmp_path: Path, ports: PortBlock) -> None:
    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (24, 24))

    command = [sys.executable, "-m", "fwk.cli.launch", "one-robot.yaml", "--bus-port", str(ports.bus)]
    environment = {**os.environ, "HOME": str(tmp_path)}
    done = run(command, stdout=subprocess.PIPE, env=environment, preexec_fn=limit)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
    assert "ulimit -n" in done.stderr
    assert not list(tmp_path.rglob("log.lcm"))


@pytest.mark.parametrize(("module", "code"), [("fwk.cli.main", 130), ("fwk.cli.launch", 0)])
def test_ctrl_c_during_imports_ends_it_tidily(module: str, code: int) -> None:
    program = (
        "import builtins, os, signal, sys\n"
        f"from {module} import main\n"
        "real = builtins.__import__\n"
        "def slow(name, *rest):\n"
        "    if name == 'typer': os.kill(os.getpid(), signal.SIGINT)\n"
        "    return real(name, *rest)\n"
        "builtins.__import__ = slow\n"
        "sys.argv = ['x', 'check', 'one-robot.yaml']\n"
        "main()\n"
    )
    done = run([sys.executable, "-c", program], stdout=subprocess.PIPE)
    assert (done.returncode, done.stderr) == (code, "interrupted before the start\n")


def test_ctrl_c_while_launch_reads_its_words_ends_it_tidily(monkeypatch: pytest.MonkeyPatch) -> None:
    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr(sys, "argv", ["fwk-launch", "--no-such-option"])
    try:
        with pytest.raises(SystemExit):
            launch.main()
        assert signal.getsignal(signal.SIGINT) is not signal.default_int_handler  # typer would end with code 130
    finally:
        signal.signal(signal.SIGINT, before)
