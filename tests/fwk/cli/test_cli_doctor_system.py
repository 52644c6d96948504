"""`fwk doctor` finds trouble with libraries, types, processes, clock, disk and cores; each trouble is produced."""

import os
from pathlib import Path
from types import SimpleNamespace

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.check import system_checks as checks
from fwk.cli.check.doctor import doctor
from fwk.cli.check.machine_checks import Finding, Severity
from fwk.lcm.typegen import generate
from fwk.plan.load import LaunchOptions, load_plan
from tests.harness.components import sources
from tests.harness.runs import write_files


def test_missing_and_old_libraries_are_named() -> None:
    assert checks.versions().level is Severity.OK
    found = checks.versions(["lcm>=99.1", "no-such-library", "typer", "absent>=1; extra == 'dev'"])
    assert found.level is Severity.BAD
    assert found.text.endswith(", needed 99.1, no-such-library is missing")
    assert found.advice == "pip install --upgrade 'lcm>=99.1' no-such-library"


def test_classes_of_an_older_file_are_found_and_mended(tmp_path: Path) -> None:
    write_files(tmp_path, sources("lcmtypes/walk.lcm"))
    folder = tmp_path / "lcmtypes"
    generate(folder)
    assert checks.stale_files([str(folder)]).level is Severity.OK
    (folder / "walk.lcm").write_text("package walk;\nstruct step_t { double y; }\n")
    found = checks.stale_files([str(folder)])
    assert (found.level, found.advice) == (Severity.WARNING, f"python -m fwk.lcm.typegen {folder}")
    assert str(folder / "walk.lcm") in found.text
    generate(folder)
    assert checks.stale_files([str(folder)]).level is Severity.OK


def test_processes_without_a_supervisor_are_named() -> None:
    whole = {
        1: (0, "init"),
        10: (5, "fwk: match supervisor"),
        11: (10, "fwk: match zygote"),
        12: (11, "fwk: match cyan1/camera"),
    }
    assert checks.orphans(lambda: whole) == Finding(Severity.OK, "processes of runs", "1 run, no process left behind")
    found = checks.orphans(lambda: {**whole, 20: (1, "fwk: other gateway"), 21: (1, "fwk: other red/base")})
    assert found.text == "without a supervisor: 20 (other gateway), 21 (other red/base)"
    assert found.advice == "kill -9 20 21"
    assert os.getpid() in checks._titles()


def test_a_padded_title_of_a_supervisor_is_its_own(monkeypatch: pytest.MonkeyPatch) -> None:
    process = SimpleNamespace(pid=7, info={"ppid": 1, "cmdline": ["fwk: match supervisor          "]})
    monkeypatch.setattr("psutil.process_iter", lambda _: [process])
    assert checks.orphans() == Finding(Severity.OK, "processes of runs", "1 run, no process left behind")


def test_a_slow_clock_and_a_wrong_date_are_found(tmp_path: Path) -> None:
    source = tmp_path / "current_clocksource"
    for name, level in (("tsc\n", Severity.OK), ("hpet\n", Severity.WARNING)):
        source.write_text(name)
        assert checks.clock(source).level is level
    assert "'hpet', which is slow" in checks.clock(source).text
    assert checks.clock(tmp_path / "none").text == "set"
    assert "before 2025" in checks.clock(source, lambda: 0).text


def test_a_slow_or_full_disk_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    times = iter([0, 100_000, 0, 8_000_000])
    fast = checks.disk(tmp_path / "not" / "made", lambda: next(times))
    assert (fast.level, fast.text) == (Severity.OK, "writes 80 MiB/s")
    slow = checks.disk(tmp_path, lambda: next(times))
    assert (slow.level, slow.text.split(":")[0]) == (Severity.WARNING, "writes 1 MiB/s")

    def full(_descriptor: int) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    assert checks.disk(tmp_path).text == "No space left on device: nothing is recorded"


def test_too_few_cores_for_a_plan_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(tmp_path, sources("walker.py", "lcmtypes/walk.lcm"))
    names = "".join(f"  r{number}/walker: {{use: walker}}\n" for number in range(9))
    (tmp_path / "many.yaml").write_text(f"name: many\nclock: wall\ncomponents:\n{names}")
    plan = load_plan(str(tmp_path / "many.yaml"), LaunchOptions())
    assert checks.cores(plan, 2) == Finding(Severity.OK, "cores for many", "9 processes on 2 cores")
    found = checks.cores(plan, 1)
    assert (found.level, found.text) == (Severity.WARNING, "9 processes on 1 core: late components in real time")
    assert found.advice == "fwk-launch FILE --hosting single"
    monkeypatch.chdir(tmp_path)
    app = typer.Typer()
    app.command()(doctor)
    assert "cores for many: 9 processes on " in CliRunner().invoke(app, ["many.yaml"]).stdout
    assert CliRunner().invoke(app, ["few.yaml"]).exit_code == 2
