"""`fwk doctor` finds problems of a machine, and its advice helps."""

import errno
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
from fwk.bus.sockets import GROUP
from fwk.cli.check import machine_checks, network_checks
from fwk.cli.check.doctor import doctor
from fwk.cli.check.findings import Finding, Severity
from fwk.model.ports import Ports
from tests.harness.runs import PortBlock

DOCTOR = [sys.executable, "-c", "import typer; from fwk.cli.check.doctor import doctor; typer.run(doctor)"]


def test_ports_of_another_run_are_named(ports: PortBlock) -> None:
    wanted = Ports(ports.bus, 3, 4)
    assert network_checks.ports(wanted).level is Severity.OK
    lock = PortLock(wanted, "other")
    try:
        found = network_checks.ports(wanted)
        advised = int(found.advice.removeprefix("fwk-launch FILE --bus-port "))
        assert network_checks.ports(Ports(advised, 3, 4)).level is Severity.OK
    finally:
        lock.release()
    assert found.level is Severity.WARNING
    assert found.text.startswith(f"used by another run (pid {os.getpid()}: ")
    assert network_checks.ports(wanted).level is Severity.OK


def test_ports_of_other_programs_are_named(ports: PortBlock) -> None:
    wanted = Ports(ports.bus, 3, 4)
    for address, port in (("127.0.0.1", wanted.supervisor), (GROUP, wanted.stage(0))):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
            taken.bind((address, port))
            found = network_checks.ports(wanted)
        assert found.level is Severity.WARNING
        assert found.text.startswith(f"other programs use {port} (pid {os.getpid()}: ")
        assert found.advice.startswith("fwk-launch FILE --bus-port ")


def test_a_taken_port_of_the_public_bus_is_named(ports: PortBlock) -> None:
    url, wanted = f"udpm://{GROUP}:{ports.bus}?ttl=0", Ports(ports.bus + 1, 1, 1)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("0.0.0.0", ports.bus))
        found = network_checks.public_bus(url, wanted)
    assert found.level is Severity.BAD
    assert found.text.startswith(f"another program has UDP port {ports.bus} for itself (pid {os.getpid()}: ")
    assert network_checks.public_bus(url, wanted).level is Severity.OK
    assert network_checks.public_bus("", wanted).level is Severity.OK


def test_missing_java_is_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    assert machine_checks.java() == Finding(
        Severity.WARNING, "Java", "no java, javac: 'fwk spy' does not work", "sudo apt install default-jdk"
    )


def test_small_buffers_and_few_files_are_warnings(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network_checks, "BUFFER_BYTES", 1 << 30)
    found = network_checks.receive_buffers()
    assert (found.level, found.advice.split(";")[0]) == (
        Severity.WARNING,
        "sudo sysctl -w net.core.rmem_max=1073741824",
    )
    limit, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (256, hard))
    try:
        few = machine_checks.open_files()
    finally:
        resource.setrlimit(resource.RLIMIT_NOFILE, (limit, hard))
    assert few == Finding(
        Severity.WARNING, "open files", "256 a process: large launch files need 1024", "ulimit -n 1024"
    )
    monkeypatch.setattr(resource, "getrlimit", lambda _: (256, 256))
    assert machine_checks.open_files().advice == "sudo prlimit --pid $$ --nofile=1024"


def test_a_firewall_is_told_from_a_missing_route(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(code: int) -> None:
        def send(*_: object) -> int:
            raise OSError(code, os.strerror(code))

        monkeypatch.setattr("socket.socket.sendto", send)

    refused(errno.EPERM)
    for check in (network_checks.multicast_loopback, network_checks.multicast_route):
        found = check()
        assert "a firewall forbids datagrams" in found.text
        assert found.advice.startswith(f"sudo iptables -I INPUT -d {GROUP} ")
    refused(errno.ENETUNREACH)
    found = network_checks.multicast_route()
    assert found.level is Severity.WARNING  # a run then uses the interface lo
    assert found.text.startswith(f"no route to {GROUP} (Network is unreachable): ")


def test_a_broken_generator_and_no_shared_memory_are_bad(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(name: str) -> int:
        raise OSError(38, "Function not implemented")

    monkeypatch.setattr(machine_checks, "lcm_gen", lambda: "/bin/false")
    monkeypatch.setattr(os, "memfd_create", refused)
    assert machine_checks.generator().level is Severity.BAD
    assert machine_checks.shared_memory() == Finding(
        Severity.BAD, "shared memory (memfd)", "Function not implemented: cameras do not work"
    )


@pytest.mark.parametrize(("level", "code"), [(Severity.OK, 0), (Severity.WARNING, 0), (Severity.BAD, 1)])
def test_only_problems_that_stop_runs_are_failures(monkeypatch: pytest.MonkeyPatch, level: Severity, code: int) -> None:
    found = [lambda: Finding(level, "gears", "turning", "oil them" if code else "")]
    monkeypatch.setattr("fwk.cli.check.doctor._checks", lambda *_: found)
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
    assert "bad      multicast on lo (inner buses): " in sick.stdout
    assert "warning  multicast by route (public bus): no route to " in sick.stdout
    script = "; ".join([*advice, 'exec "$@"'])
    well = subprocess.run(
        [*without_network, "sh", "-c", script, "sh", *DOCTOR], capture_output=True, text=True, check=False
    )
    assert "ok       multicast by route (public bus)" in well.stdout
    assert "ok       multicast on lo (inner buses)" in well.stdout
    assert well.returncode == 0
