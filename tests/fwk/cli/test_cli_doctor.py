"""`fwk doctor` finds problems of a machine, and its advice helps."""

import os
import resource
import socket
import subprocess
import sys
from collections.abc import Callable

import pytest
import typer
from typer.testing import CliRunner

from fwk.bus.port_lock import PortLock
from fwk.cli.check import machine_checks as checks
from fwk.cli.check.doctor import doctor
from fwk.cli.check.machine_checks import Finding, Severity
from fwk.model.ports import Ports
from tests.harness.runs import PortBlock

DOCTOR = [sys.executable, "-c", "import typer; from fwk.cli.check.doctor import doctor; typer.run(doctor)"]


def test_ports_of_another_run_are_named(ports: PortBlock) -> None:
    wanted = Ports(ports.bus, 3, 4)
    assert checks.ports(wanted).level is Severity.OK
    lock = PortLock(wanted, "other")
    try:
        found = checks.ports(wanted)
    finally:
        lock.release()
    assert found.level is Severity.WARNING
    assert "are used by another run" in found.text
    assert checks.ports(wanted).level is Severity.OK


def test_ports_of_other_programs_are_named(ports: PortBlock) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", ports.bus + 2))
        found = checks.ports(Ports(ports.bus, 3, 4))
    assert (found.level, found.text) == (Severity.WARNING, f"other programs use {ports.bus + 2}")
    assert found.advice.startswith("fwk-launch FILE --bus-port ")


def test_missing_java_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert checks.java() == Finding(
        Severity.WARNING, "Java", "no java, javac: 'fwk spy' does not work", "sudo apt install default-jdk"
    )


def test_small_buffers_and_few_files_are_warnings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(checks, "BUFFER_BYTES", 1 << 30)
    found = checks.receive_buffers()
    assert (found.level, found.advice.split(";")[0]) == (
        Severity.WARNING,
        "sudo sysctl -w net.core.rmem_max=1073741824",
    )
    limit, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (256, hard))
    try:
        few = checks.open_files()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (limit, hard))
    assert few == Finding(
        Severity.WARNING, "open files", "256 a process: large launch files need 1024", "ulimit -n 1024"
    )


def test_a_broken_generator_and_no_shared_memory_are_bad(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(name: str) -> int:
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(checks, "lcm_gen", lambda: "/bin/false")
    monkeypatch.setattr(os, "memfd_create", refused)
    assert checks.generator().level is Severity.BAD
    assert checks.shared_memory() == Finding(
        Severity.BAD, "shared memory (memfd)", "Function not implemented: cameras do not work"
    )


@pytest.mark.parametrize(("level", "code"), [(Severity.OK, 0), (Severity.WARNING, 0), (Severity.BAD, 1)])
def test_only_problems_that_stop_runs_are_failures(monkeypatch: pytest.MonkeyPatch, level: Severity, code: int) -> None:
    found = [lambda: Finding(level, "gears", "turning", "oil them" if code else "")]
    monkeypatch.setattr("fwk.cli.check.doctor.all_checks", lambda wanted: found)
    monkeypatch.setattr("fwk.cli.check.doctor.system_checks", lambda plan: [])
    app = typer.Typer()
    app.command()(doctor)
    result = CliRunner().invoke(app, [])
    advice = "         type: oil them\n" if code else ""
    assert (result.exit_code, result.stdout) == (code, f"{level:8} gears: turning\n{advice}")


@pytest.mark.system
def test_missing_multicast_is_found_and_the_advice_helps(
    needs: Callable[..., None], leave_out: Callable[[str], None]
) -> None:
    needs("unshare", "ip")
    without_network = ["unshare", "--user", "--map-root-user", "--net"]
    if subprocess.run([*without_network, "true"], check=False, capture_output=True).returncode:
        leave_out("needs the right to make a network namespace: run as root")
    sick = subprocess.run([*without_network, *DOCTOR], capture_output=True, text=True, check=False)
    assert sick.returncode == 1
    advice = [
        line.split("type: ")[1].replace("sudo ", "") for line in sick.stdout.splitlines() if "type: sudo ip" in line
    ]
    assert len(advice) == 2
    assert "bad      multicast by route (public bus): " in sick.stdout
    script = "; ".join([*advice, 'exec "$@"'])
    well = subprocess.run(
        [*without_network, "sh", "-c", script, "sh", *DOCTOR], capture_output=True, text=True, check=False
    )
    assert "ok       multicast by route (public bus)" in well.stdout
    assert "ok       multicast on lo (inner buses)" in well.stdout
    assert well.returncode == 0
