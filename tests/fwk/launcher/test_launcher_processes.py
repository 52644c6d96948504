"""Processes of a run as other programs see them: their names, and ports that no other process can take."""

import errno
import json
import os
import signal
import socket
from pathlib import Path

import psutil
import pytest

from fwk.model.plan import Plan
from fwk.model.plan_document import plan_from
from fwk.model.ports import Ports
from tests.harness.fixtures import Launch, folder, launch, orchestra_types
from tests.harness.runs import Launched, PortBlock

__all__ = ["folder", "launch", "orchestra_types"]

FILE = "launch/orchestra.yaml"

pytestmark = pytest.mark.system


@pytest.fixture
def traced(folder: Path) -> Path:
    (folder / "traces").mkdir()
    return folder


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


def test_port_of_a_killed_host_cannot_be_taken(launch: Launch, traced: Path, ports: PortBlock) -> None:
    file = traced / FILE
    file.write_text(file.read_text().replace("d/player: {", "d/player: { restart: {backoff_s: 0.5},"))
    run = launch(FILE)
    run.until_ticks("f/player", 3)
    port = ports_of(run).host(host_index(run, "d/player"))
    os.kill(run.host("d/player"), signal.SIGKILL)
    run.until("d/player ended: killed by signal 9")
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as thief:
        thief.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        assert errno.errorcode[bound(thief, port)] == "EADDRINUSE"
    run.until("d/player runs again, start number 2")
    run.until_ticks("f/player", 3)
    run.signal(signal.SIGINT)
    assert run.wait() == 0, run.text


def test_a_used_port_is_named_before_any_process_starts(launch: Launch, traced: Path, ports: PortBlock) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        port = Ports(ports.bus, 1, 0).host(0)
        other.bind(("127.0.0.1", port))
        run = launch(FILE)
        assert run.wait() == 2, run.text
    assert f"another program uses UDP port {port}" in run.text
    assert "Traceback" not in run.text
    assert not [process for process in run.processes() if process.status() != psutil.STATUS_ZOMBIE]


def bound(thief: socket.socket, port: int) -> int:
    """Tries to take a port; returns the system's error number, 0 if the port was free."""
    try:
        thief.bind(("127.0.0.1", port))
    except OSError as error:
        return error.errno or 0
    return 0


def ports_of(run: Launched) -> Ports:
    return Ports.of(plan_of(run))


def host_index(run: Launched, name: str) -> int:
    return next(host.index for host in plan_of(run).hosts if host.name == name)


def plan_of(run: Launched) -> Plan:
    return plan_from(json.loads((run.run_dir / "plan.json").read_text()))
