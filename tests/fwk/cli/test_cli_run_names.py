"""Runs have names and records: they start in the background, are listed, found by name, and ended from elsewhere."""

import json
import re
import socket
import subprocess
from collections.abc import Iterator
from pathlib import Path

import pytest

from fwk.cli.run.run_directory import RUNS
from fwk.cli.run.run_record import RESULT_FILE, RUN_FILE, RunRecord, read_record
from tests.fwk.cli.cli_processes import PROCS, launch, run, write_files
from tests.harness.runs import Launched, PortBlock


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    write_files(tmp_path, PROCS)
    return tmp_path


def listed(folder: Path, *command: str) -> list[dict[str, object]]:
    found: list[dict[str, object]] = json.loads(run(folder, *command, "--json").stdout)
    return found


@pytest.fixture
def name(ports: PortBlock) -> str:
    """A name that no run of another test has: all runs of the machine are found by their names."""
    return f"cards-{ports.bus}"


@pytest.fixture
def detached(folder: Path, ports: PortBlock, name: str) -> Iterator[subprocess.CompletedProcess[str]]:
    command = ["fwk-launch", "cards.yaml", "--run", name, "--bus-port", str(ports.bus), "--seed", "7"]
    started = run(folder, *command, "--detach", "--time", "300")  # ends by itself if the test is killed
    yield started
    run(folder, "fwk", "stop", "--all", "--run", name)


@pytest.mark.slow
@pytest.mark.system
@pytest.mark.core
def test_a_run_in_the_background_is_found_and_ended(
    folder: Path, detached: subprocess.CompletedProcess[str], ports: PortBlock, name: str
) -> None:
    assert detached.returncode == 0, detached.stdout
    assert f"{name}: runs in the background" in detached.stdout
    (mine,) = (each for each in listed(folder, "fwk", "ps") if each.get("name") == name)
    assert mine["bus_port"] == ports.bus
    status = run(folder, "fwk", "status", "--run", name)
    assert (status.returncode, "left/counter" in status.stdout) == (0, True)
    (row,) = listed(folder, "fwk", "runs", "list")
    assert (row["name"], row["seed"], row["in_use"], row["result"]) == (name, 7, True, "")
    again = run(folder, "fwk-launch", "cards.yaml", "--run", name)
    assert again.returncode == 2
    assert f"a run is called '{name}' already" in " ".join(again.stdout.replace("│", " ").split())
    ended = run(folder, "fwk", "stop", "--all", "--run", name)
    assert (ended.returncode, f"{name}: ended" in ended.stdout) == (0, True), ended.stdout + ended.stderr
    (row,) = listed(folder, "fwk", "runs", "list")
    assert (row["result"], row["exit_code"], row["in_use"]) == ("interrupted", 0, False)
    assert run(folder, "fwk", "status", "--run", name).returncode == 2


@pytest.mark.system
def test_an_immediate_failure_of_a_detached_run_is_reported(folder: Path) -> None:
    (folder / "procs" / "counter.py").write_text(
        PROCS["procs/counter.py"] + "\n    def init(self) -> None:\n        1 / 0\n"
    )
    result = launch(folder, "cards.yaml", "--detach")
    assert result.returncode == 1
    assert "ZeroDivisionError" in result.stdout


SLEEPER = """
from pathlib import Path
from fwk import Component
from fwk.clock import sleep_s
class Sleeper(Component):
    stage = "think"
    def init(self) -> None:
        while not Path("awake").exists():
            sleep_s(0.01)
    def loop(self) -> None:
        pass
"""


@pytest.mark.system
def test_detach_names_the_component_that_the_start_waits_for(folder: Path, ports: PortBlock, name: str) -> None:
    write_files(folder, {"procs/sleeper.py": SLEEPER, "launch/slow.yaml": "components: {a/bed: {use: procs.sleeper}}"})
    launched = Launched(folder, ports, ("slow.yaml", "--run", name, "--ticks", "5", "--detach"), {})
    told = re.compile(rf"^{name}: the start has waited [1-9]\d* s for a/bed$", re.MULTILINE)
    try:
        launched.until_true(lambda: told.search(launched.text) is not None, "the name of the component")
        (folder / "awake").touch()
        assert launched.wait() == 0, launched.text
    finally:
        launched.end()


@pytest.mark.system
@pytest.mark.parametrize("output", [">/dev/full", ">&-", "| true"])
def test_detach_without_output_reports_on_stderr(folder: Path, ports: PortBlock, name: str, output: str) -> None:
    typed = f"fwk-launch cards.yaml --bus-port {ports.bus} --run {name} --time 300 --detach {output}"
    shell = run(folder, "bash", "-o", "pipefail", "-c", typed)
    ended = run(folder, "fwk", "stop", "--all", "--run", name)
    assert shell.returncode == 0, shell.stdout
    assert ended.returncode == 0, ended.stdout
    if "full" in output:
        assert f"standard output cannot be written; the run goes on\n{name}: runs in the background" in shell.stdout


@pytest.mark.system
def test_a_refused_run_leaves_no_directory(folder: Path, ports: PortBlock) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as squatter:
        squatter.bind(f"\0fwk-control-{ports.bus}")
        result = run(folder, "fwk-launch", "cards.yaml", "--ticks", "3", "--bus-port", str(ports.bus))
    assert result.returncode == 2
    assert "another process has the control socket" in result.stdout
    assert "Traceback" not in result.stdout
    assert not (folder / RUNS).exists() or not list((folder / RUNS).iterdir())


@pytest.mark.parametrize("name", ["7", "", "a b", "x" * 80, "-a", "a/b"])
def test_names_that_could_be_ports_or_paths_are_refused(folder: Path, name: str) -> None:
    result = run(folder, "fwk-launch", "cards.yaml", f"--run={name}")
    assert result.returncode == 2
    assert "is not a run name" in " ".join(result.stdout.replace("│", " ").split())


@pytest.mark.parametrize("typed", [["stop"], ["stop", "--all", "a/b"]])
def test_stop_needs_either_names_or_all(folder: Path, typed: list[str]) -> None:
    result = run(folder, "fwk", *typed)
    assert result.returncode == 2
    assert "name components, or end the whole run with --all" in " ".join(result.stdout.replace("│", " ").split())


@pytest.mark.parametrize("content", ["", "[]", "{", "null", '{"seed": "x", "duration_s": -1, "result": 7}', "[" * 5000])
def test_a_damaged_record_is_ignored(tmp_path: Path, content: str) -> None:
    (tmp_path / RUN_FILE).write_text(content)
    (tmp_path / RESULT_FILE).write_text(content)
    read = read_record(tmp_path)
    assert (read.started_us, read.seed, read.duration_s, read.exit_code) == (None, None, None, None)
    assert read_record(tmp_path / "none") == RunRecord()
