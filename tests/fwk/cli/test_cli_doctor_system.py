"""`fwk doctor` finds trouble with libraries, types, processes, clock, disk and cores; each trouble is produced."""

import errno
import os
from pathlib import Path
from types import SimpleNamespace
from typing import cast
from unittest.mock import Mock

import pytest
import typer
from typer.testing import CliRunner

from fwk.cli.check import system_checks as checks
from fwk.cli.check.doctor import doctor
from fwk.cli.check.findings import Finding, Severity
from fwk.display.cores import memory_limit_bytes, usable_cores
from fwk.lcm.typegen import generate
from fwk.model.plan import Plan
from fwk.plan.load import LaunchOptions, load_plan
from tests.harness.components import sources
from tests.harness.runs import write_files


def test_missing_and_old_libraries_are_named() -> None:
    assert checks.versions().level is Severity.OK
    found = checks.versions(["lcm>=99.1", "no-such-library", "typer", "absent>=1; extra == 'dev'"])
    assert found.level is Severity.BAD
    assert found.text.endswith(", needed 99.1, no-such-library is missing")
    assert found.advice == "pip install --upgrade 'lcm>=99.1' no-such-library"


def test_classes_of_an_older_file_are_found_and_mended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(tmp_path, sources("lcmtypes/walk.lcm"))
    folder = tmp_path / "lcmtypes"
    generate(folder)
    assert checks.stale_files([str(folder)]).level is Severity.OK
    (folder / "walk.lcm").write_text("package walk;\nstruct step_t { double y; }\n")
    found = checks.stale_files([str(folder)])
    assert (found.level, found.advice) == (Severity.WARNING, f"python -m fwk.lcm.typegen {folder}")
    assert str(folder / "walk.lcm") in found.text
    monkeypatch.chdir(tmp_path)
    assert checks.stale_files() == found
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
    available = tmp_path / "available_clocksource"
    available.write_text("hpet kvm-clock acpi_pm\n")
    for name, level in (("tsc\n", Severity.OK), ("hpet\n", Severity.WARNING)):
        source.write_text(name)
        assert checks.clock(source).level is level
    assert "'hpet', which is slow" in checks.clock(source).text
    assert checks.clock(source).advice == f"echo kvm-clock | sudo tee {source}"
    available.unlink()
    assert checks.clock(source).text.endswith("it offers no faster one")
    assert checks.clock(tmp_path / "none").text == "set"
    assert "before 2025" in checks.clock(source, lambda: 0).text


def test_a_slow_or_full_disk_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    times = iter([0, 100_000, 0, 8_000_000])
    fast = checks.disk(tmp_path / "not" / "made", lambda: next(times))
    assert (fast.level, fast.text) == (Severity.OK, "writes 80 MiB/s")
    slow = checks.disk(tmp_path, lambda: next(times))
    assert (slow.level, slow.text.split(":")[0]) == (Severity.WARNING, "writes 1 MiB/s")

    for code, text, advice in (
        (errno.ENOSPC, "No space left on device", "fwk runs prune --keep 10; "),
        (errno.EROFS, "Read-only file system", "sudo mount -o remount,rw "),
        (errno.EACCES, "Permission denied", "sudo chown $USER "),
    ):
        refused = OSError(code, text)
        monkeypatch.setattr(os, "fsync", Mock(side_effect=refused))
        found = checks.disk(tmp_path)
        assert (found.level, found.text) == (Severity.BAD, f"{text}: nothing is recorded")
        assert found.advice.startswith(advice)


def test_too_few_cores_for_a_plan_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(tmp_path, sources("walker.py", "lcmtypes/walk.lcm"))
    names = "".join(f"  r{number}/walker: {{use: walker}}\n" for number in range(9))
    (tmp_path / "many.yaml").write_text(f"name: many\nclock: wall\ncomponents:\n{names}")
    plan = load_plan(str(tmp_path / "many.yaml"), LaunchOptions())
    assert checks.cores(plan, 2) == Finding(Severity.OK, "cores for many", "9 processes on 2 cores")
    found = checks.cores(plan, 1)
    assert (found.level, found.text) == (Severity.WARNING, "9 processes on 1 core: late components in real time")
    assert found.advice == "fwk-launch FILE --hosting single"
    many = SimpleNamespace(hosts=plan.hosts * 4, components=plan.components, name="many", clock="logical")
    assert checks.cores(cast(Plan, many), 2).advice == "fwk-launch FILE --hosting robot"
    assert checks.cores(cast(Plan, many), 1).advice == "fwk-launch FILE --hosting single"
    monkeypatch.chdir(tmp_path)
    app = typer.Typer()
    app.command()(doctor)
    assert "cores for many: 9 processes on " in CliRunner().invoke(app, ["many.yaml"]).stdout
    assert CliRunner().invoke(app, ["few.yaml"]).exit_code == 2
    assert "cores for many: 1 process on " in CliRunner().invoke(app, ["many.yaml", "--hosting", "single"]).stdout
    record = CliRunner().invoke(app, ["--record", str(tmp_path / "log.lcm")])
    assert f"disk of {tmp_path}: writes " in record.stdout


@pytest.mark.parametrize(
    ("line", "files", "cores"),
    [
        ("0::/box", {"box/cpu.max": "50000 100000\n"}, 1),
        ("0::/box/inner", {"box/inner/cpu.max": "max 100000\n", "box/cpu.max": "150000 100000\n"}, 2),
        ("1:cpu,cpuacct:/box", {"cpu/box/cpu.cfs_quota_us": "90000\n", "cpu/box/cpu.cfs_period_us": "100000\n"}, 1),
        ("1:cpu:/", {"cpu/cpu.cfs_quota_us": "-1\n", "cpu/cpu.cfs_period_us": "100000\n"}, 8),
        ("4:memory:/box", {}, 8),
    ],
)
def test_cores_that_a_control_group_grants_are_counted(
    line: str, files: dict[str, str], cores: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: range(8))
    write_files(tmp_path, {**files, "groups": f"{line}\n"})
    assert usable_cores(tmp_path / "groups", tmp_path) == cores


@pytest.mark.parametrize(
    ("line", "files", "limit_bytes"),
    [
        ("0::/box/inner", {"box/inner/memory.max": "max\n", "box/memory.max": "1000\n"}, 1000),
        ("4:memory:/box", {"memory/box/memory.limit_in_bytes": "2000\n"}, 2000),
        ("1:cpu:/box", {"memory/box/memory.limit_in_bytes": "2000\n"}, None),
    ],
)
def test_memory_that_a_control_group_grants_is_known(
    line: str, files: dict[str, str], limit_bytes: int | None, tmp_path: Path
) -> None:
    write_files(tmp_path, {**files, "groups": f"{line}\n"})
    assert memory_limit_bytes(tmp_path / "groups", tmp_path) == limit_bytes
