"""Ports of a run and the lock on them."""

import re

import pytest

from fwk.bus.port_lock import PortLock, PortsInUseError
from fwk.model.ports import Ports
from tests.harness.runs import PortBlock


def test_no_port_has_two_uses() -> None:
    ports = Ports(20_000, hosts=105, channels=300)
    used = [ports.sync, ports.record, ports.log, ports.status, ports.supervisor]
    used += [ports.stage(index) for index in range(30)]
    used += [ports.host(index) for index in range(106)] + [ports.channel(index) for index in range(300)]
    assert len(set(used)) == len(used)
    assert max(used) < ports.end


def test_second_run_on_the_same_ports_says_what_to_type(ports: PortBlock) -> None:
    lock, overlapping = PortLock(Ports(ports.bus, 5, 5), "soccer.yaml"), Ports(ports.bus + 10, 5, 5)
    told = rf"second.yaml: ports {overlapping.base} .*another run \(pid \d+: .*--bus-port \d+"
    with pytest.raises(PortsInUseError, match=told):
        PortLock(overlapping, "second.yaml")
    lock.release()
    PortLock(overlapping, "second.yaml").release()


def test_two_runs_do_not_mirror_to_the_same_public_bus(ports: PortBlock) -> None:
    bus, other = ports.public_url, PortBlock()
    lock = PortLock(Ports(ports.bus, 5, 5), "soccer.yaml", bus)
    told = f"second.yaml: the public bus {re.escape(bus.partition('?')[0])} .*another public_url"
    with pytest.raises(PortsInUseError, match=told):
        PortLock(Ports(other.bus, 5, 5), "second.yaml", bus.replace("ttl=0", "ttl=1"))
    lock.release()
    other.release()
