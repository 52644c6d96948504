"""Requirements of a run on the machine are checked before any process starts, with advice."""

import os
import resource
import socket
import subprocess
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from fwk.bus.sockets import LOOPBACK
from fwk.cli.run.run_directory import RUNS
from fwk.control.address import gateway_address, supervisor_address
from fwk.launcher import machine
from fwk.launcher.machine import MachineError, advice, check_machine, check_ports
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from tests.fwk.cli.cli_processes import PROCS, run, write_files
from tests.fwk.cli.cli_runs import plan as some_plan


@pytest.fixture
def plan(free_port: int) -> Plan:
    return replace(some_plan(), bus_port=free_port, public_url="")


@pytest.fixture
def free_port() -> int:
    from tests.harness.runs import PortBlock

    with PortBlock() as ports:
        return ports.bus


def test_a_machine_that_has_everything_is_accepted(plan: Plan) -> None:
    check_machine(plan)


def test_a_port_of_another_program_is_named(plan: Plan) -> None:
    port = Ports.of(plan).supervisor
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind((LOOPBACK, port))
        with pytest.raises(
            MachineError, match=rf"uses UDP port {port} \(pid {os.getpid()}: .*\); end it, .* --bus-port"
        ):
            check_ports(plan)
    check_ports(plan)


@pytest.mark.parametrize("address", [supervisor_address, gateway_address])
def test_a_control_name_of_another_process_is_named(plan: Plan, address: type) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as squatter:
        squatter.bind(address(plan.bus_port))
        with pytest.raises(MachineError, match=f"has the control socket @fwk-.*-{plan.bus_port}; .* --bus-port"):
            check_machine(plan)


@pytest.mark.system
@pytest.mark.parametrize(
    ("before", "remedy"),
    [
        ("true", "ip link set lo up multicast on"),
        ("ip link set lo up && ip address del 127.0.0.1/8 dev lo", "ip address add 127.0.0.1/8 dev lo"),
    ],
    ids=["down", "IPv6 only"],
)
def test_a_missing_network_is_named_and_the_advice_helps(
    before: str, remedy: str, tmp_path: Path, needs: Callable[..., None], leave_out: Callable[[str], None]
) -> None:
    needs("unshare", "ip")
    without_network = ["unshare", "--user", "--map-root-user", "--net", "sh", "-c"]
    if subprocess.run([*without_network, "true"], check=False, capture_output=True).returncode:
        leave_out("needs the right to make a network namespace: run as root")
    write_files(tmp_path, PROCS)
    start = "fwk-launch cards.yaml --ticks 2"
    sick = run(tmp_path, *without_network, f"{before} && {start}")
    assert (sick.returncode, "Traceback" in sick.stdout) == (2, False), sick.stdout
    assert sick.stdout.startswith("no IPv4 multicast on the interface lo: ")
    assert sick.stdout.endswith(f"; type: sudo {remedy}\n")
    assert not list((tmp_path / RUNS).glob("*"))
    well = run(tmp_path, *without_network, f"{before} && {remedy} && {start}")
    assert well.returncode == 0, well.stdout


def test_a_public_bus_that_cannot_be_opened_is_named(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(_: str) -> None:
        raise OSError(19, "No such device")

    monkeypatch.setattr(machine, "PublicBus", refuse)
    with pytest.raises(MachineError, match=r"the public bus udpm://.* cannot be opened: No such device; 'fwk doctor'"):
        check_machine(replace(plan, public_url="udpm://239.255.76.67:7667?ttl=0"))


def test_a_public_bus_that_is_taken_names_the_program(plan: Plan, free_port: int) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", free_port))
        with pytest.raises(MachineError, match=rf"cannot be opened: Address already in use \(pid {os.getpid()}: .*\);"):
            check_machine(replace(plan, bus_port=free_port + 64, public_url=f"udpm://239.255.76.67:{free_port}?ttl=0"))


def test_too_few_open_files_are_named(plan: Plan, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(resource, "getrlimit", lambda _: (24, 24))
    with pytest.raises(MachineError, match=r"about \d+ open files in a process, 24 are allowed; .* ulimit -n 1024"):
        check_machine(plan)


def crowd(plan: Plan, robots: int, processes: int) -> Plan:
    component = type("Named", (), {})
    components = []
    for number in range(processes):
        made = component()
        made.name = f"robot{number % robots}/part{number}"
        components.append(made)
    return replace(plan, components=tuple(components), hosts=tuple(range(processes)))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("robots", "processes", "words"),
    [
        (10, 104, ["104 processes share 2 cores: if the run is slower than real time, start it with --hosting robot"]),
        (40, 40, ["40 processes share 2 cores: if the run is slower than real time, start it with --hosting single"]),
        (2, 8, []),
    ],
)
def test_too_few_cores_are_reported_with_the_helpful_flag(
    plan: Plan, robots: int, processes: int, words: list[str]
) -> None:
    assert advice(crowd(plan, robots, processes), cores=2, free_bytes=64 << 30) == words


def test_too_little_memory_is_reported_with_the_helpful_flag(plan: Plan) -> None:
    (line,) = advice(crowd(plan, 10, 104), cores=64, free_bytes=500 << 20)
    assert "104 processes need some 1398 MB of memory, and 500 MB are free: start the run with --hosting robot" in line
