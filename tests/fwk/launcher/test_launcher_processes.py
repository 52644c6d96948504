"""Processes of a run as other programs see them: their names, and ports that no other process can take."""

import contextlib
import json
import os
import signal
import socket
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import psutil
import pytest

from fwk import Component, Writes
from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.bus.sockets import GROUP, LOOPBACK
from fwk.cli.run.free_ports import on_free_ports
from fwk.control.address import gateway_address, supervisor_address
from fwk.control.server import ControlNameError
from fwk.launcher.reservations import Reservations
from fwk.model.plan import Plan
from fwk.model.plan_document import plan_from
from fwk.model.ports import Ports
from fwk.testing import plans
from lcmtypes.soccer import pose_t
from tests.harness.fixtures import Launch, folder, launch, orchestra_types
from tests.harness.runs import Launched, PortBlock

__all__ = ["folder", "launch", "orchestra_types"]

FILE = "launch/orchestra.yaml"

pytestmark = pytest.mark.system


@pytest.fixture
def traced(folder: Path) -> Path:
    (folder / "traces").mkdir()
    return folder


class Talker(Component):
    stage = "think"
    pose: Writes[pose_t]


def titles(run: Launched) -> dict[str, str]:
    """Returns full name to short name of all processes, as ps and top read them."""
    found = {}
    for process in run.processes():
        proc = Path("/proc", str(process.pid))
        words = proc.joinpath("cmdline").read_bytes().rstrip(b"\0 ").decode()
        found[words] = proc.joinpath("comm").read_text().strip()
    return found


def test_processes_are_named_by_plan_and_role(launch: Launch, traced: Path) -> None:
    run = launch(FILE)
    run.until_ticks("f/player", 3)
    found = titles(run)
    roles = {"supervisor", "gateway", "display", "zygote", "d/player", "world/conductor"}
    assert {f"fwk: orchestra {role}" for role in roles} <= set(found)
    assert found["fwk: orchestra world/conductor"] == "world/conductor"
    assert found["fwk: orchestra supervisor"] == "supervisor"
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text


def test_no_port_can_be_taken_while_a_host_restarts(launch: Launch, traced: Path, ports: PortBlock) -> None:
    file = traced / FILE
    file.write_text(file.read_text().replace("f/player: {", "f/player: { restart: {backoff_s: 0.5},"))
    run = launch(FILE)
    run.until_ticks("f/player", 3)
    used = ports_of(run)
    os.kill(run.host("f/player"), signal.SIGKILL)  # the only host of its stage
    run.until("f/player ended: killed by signal 9")
    with contextlib.ExitStack() as thieves:
        taken = [
            (port, address, options)
            for port in range(used.base, used.end)
            for address in (LOOPBACK if port in used.members else GROUP, "")
            for options in ((), (socket.SO_REUSEADDR,))
            if bound(thieves, address, port, options) == 0
        ]
        run.until("f/player runs again, incarnation 2")
    assert taken == []
    run.until_ticks("f/player", 3)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text
    assert "Traceback" not in run.text


def locked(plan: Plan) -> PortLock:
    return PortLock(Ports.of(plan), plan.name, plan.public_url)


def test_named_runs_that_start_together_get_ports_of_their_own(ports: PortBlock) -> None:
    plan = replace(plan_of_one(ports.bus), public_url=ports.public_url)
    one, lock = on_free_ports(plan)
    other, other_lock = on_free_ports(plan)
    with pytest.raises(PortsInUseError, match=f"used by another run.*pid {os.getpid()}"):
        locked(one)
    assert Ports.of(one).end <= Ports.of(other).base
    assert one.public_url != other.public_url
    lock.release()
    other_lock.release()
    locked(one).release()


def test_a_run_in_the_background_is_named_as_holder(ports: PortBlock) -> None:
    plan = plan_of_one(ports.bus)
    lock = locked(plan)
    here, there = socket.socketpair()
    child = os.fork()
    if not child:
        here.close()
        lock.belong_to_this_process()
        there.send(b".")
        there.recv(1)  # until the test has looked
        os._exit(0)
    there.close()
    with here:
        here.recv(1)
        with pytest.raises(PortsInUseError, match=f"pid {child}"):
            locked(plan)
    os.waitpid(child, 0)
    lock.release()


@pytest.mark.parametrize("at", ["host", "gateway", "stage", "channel"])
def test_port_that_is_taken_late_is_named_with_its_owner(at: str, ports: PortBlock) -> None:
    plan = plan_of_one(ports.bus)
    port = {"host": Ports.of(plan).host(0), "gateway": Ports.of(plan).host(1)}.get(at)
    port = port or {"stage": Ports.of(plan).stage(3), "channel": Ports.of(plan).channel(0)}[at]
    with contextlib.ExitStack() as thieves:
        assert bound(thieves, "", port, ()) == 0
        with pytest.raises(PortsInUseError, match=rf"UDP port {port} .* \(pid {os.getpid()}: .*another --bus-port"):
            Reservations(plan, locked(plan))
    Reservations(plan, locked(plan)).release()  # the first attempt kept nothing


@pytest.mark.parametrize("address", [supervisor_address, gateway_address])
def test_control_name_that_is_taken_late_is_named(address: Callable[[int], str], ports: PortBlock) -> None:
    plan = plan_of_one(ports.bus)
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as thief:
        thief.bind(address(ports.bus))
        with pytest.raises(ControlNameError, match=f"control socket @fwk-.*-{ports.bus}; end it"):
            Reservations(plan, locked(plan))
    Reservations(plan, locked(plan)).release()


def test_a_used_port_is_named_before_any_process_starts(launch: Launch, traced: Path, ports: PortBlock) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        port = Ports(ports.bus, 1, 0).host(0)
        other.bind(("127.0.0.1", port))
        run = launch(FILE)
        assert run.wait() == 2, run.text
    assert f"another program uses UDP port {port}" in run.text
    assert "Traceback" not in run.text
    assert not [process for process in run.processes() if process.status() != psutil.STATUS_ZOMBIE]


def bound(thieves: contextlib.ExitStack, address: str, port: int, options: Sequence[int]) -> int:
    """Tries to take a port and to keep it; returns the system's error number, 0 if the port was free."""
    thief = thieves.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
    for option in options:
        thief.setsockopt(socket.SOL_SOCKET, option, 1)
    try:
        thief.bind((address, port))
    except OSError as error:
        return error.errno or 0
    return 0


def plan_of_one(bus_port: int) -> Plan:
    return plans.plan_of({"a/talker": Talker}, bus_port=bus_port, public_url="")


def ports_of(run: Launched) -> Ports:
    return Ports.of(plan_of(run))


def plan_of(run: Launched) -> Plan:
    return plan_from(json.loads((run.run_dir / "plan.json").read_text()))
