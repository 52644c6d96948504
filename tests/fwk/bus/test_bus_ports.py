"""Ports of a run and the lock on them."""

import pytest

from fwk.bus.ports import PortLock, Ports, PortsInUse


def test_no_port_has_two_uses() -> None:
    ports = Ports(20_000, hosts=105, channels=300)
    used = [ports.sync, ports.record, ports.log, ports.status, ports.supervisor]
    used += [ports.stage(index) for index in range(30)]
    used += [ports.host(index) for index in range(106)] + [ports.channel(index) for index in range(300)]
    assert len(set(used)) == len(used)
    assert max(used) < ports.end


def test_a_second_run_on_overlapping_ports_is_told_who_has_them_and_what_to_type() -> None:
    lock = PortLock(Ports(30_000, 5, 5), "soccer.yaml")
    with pytest.raises(PortsInUse, match=r"second.yaml: ports 30010 .*another run \(pid \d+: .*--bus-port \d+"):
        PortLock(Ports(30_010, 5, 5), "second.yaml")
    lock.release()
    PortLock(Ports(30_010, 5, 5), "second.yaml").release()


def test_two_runs_do_not_mirror_to_the_same_public_bus() -> None:
    bus = "udpm://239.255.76.67:7999?ttl=0"
    lock = PortLock(Ports(30_000, 5, 5), "soccer.yaml", bus)
    with pytest.raises(PortsInUse, match=r"second.yaml: the public bus udpm://239.255.76.67:7999 .*another public_url"):
        PortLock(Ports(31_000, 5, 5), "second.yaml", bus.replace("ttl=0", "ttl=1"))
    lock.release()
