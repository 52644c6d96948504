"""Peers that do not answer, or vanish, and addresses to which this machine cannot connect."""

import errno
import os
import socket
from typing import Any

import pytest

from fwk.testing import Bench
from procs.refbox.client import RefBoxClient
from procs.refbox.server import RefBoxServer
from tests.procs.refbox.base_station import BaseStation


def test_each_address_of_a_name_is_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    """`localhost` is ::1 and 127.0.0.1; a RefBox may listen at either."""
    ask = socket.getaddrinfo

    def two(host: str, port: int, **how: Any) -> Any:
        addresses = ("127.0.0.2", "127.0.0.1") if host == "refbox.example" and not how["flags"] else (host,)
        return [found for address in addresses for found in ask(address, port, **how)]

    monkeypatch.setattr(socket, "getaddrinfo", two)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        listening.settimeout(5.0)
        port = listening.getsockname()[1]
        bench = Bench(RefBoxClient, "world/refbox", host="refbox.example", port=port, retry_s=0.2)
        for refusals in (1, 0):  # the second time after the RefBox has ended: the address that answered is tried first
            while not any("connected" in line.text for line in bench.logged):
                bench.iterate()
            listening.accept()[0].close()
            while not any("lost" in line.text for line in bench.logged):
                bench.iterate()
            refused = [line.text for line in bench.logged if "Connection refused" in line.text]
            assert len(refused) == refusals
            bench.logged.clear()
        bench.finalize()


@pytest.mark.parametrize("number", [errno.EAFNOSUPPORT, errno.EMFILE])
def test_socket_that_cannot_be_made_is_told_once(monkeypatch: pytest.MonkeyPatch, number: int) -> None:
    bench = Bench(RefBoxClient, "world/refbox", retry_s=0.2)

    def fail(*_: object) -> None:
        raise OSError(number, os.strerror(number))

    with monkeypatch.context() as patched:
        patched.setattr(socket, "socket", fail)
        bench.iterate(20)
    bench.finalize()
    assert [line.text for line in bench.logged] == [
        f"no RefBox at 127.0.0.1:28097: {os.strerror(number)}; it is tried again every 0.2 s"
    ]


def test_machine_that_is_switched_off_is_noticed_in_20_s(monkeypatch: pytest.MonkeyPatch) -> None:
    """Such a machine says no farewell; the system has to ask, and must not send on for a quarter of an hour."""
    made: list[socket.socket] = []

    class Recorded(socket.socket):
        def connect_ex(self, address: Any) -> int:
            made.append(self)
            return super().connect_ex(address)

    with socket.create_server(("127.0.0.1", 0)) as listening:
        bench = Bench(RefBoxClient, "world/refbox", port=listening.getsockname()[1])
        monkeypatch.setattr(socket, "socket", Recorded)
        bench.iterate()
        assert absence_s(made[0]) == 20.0
        bench.finalize()


def test_base_station_that_is_switched_off_leaves_in_20_s() -> None:
    bench = Bench(RefBoxServer, "world/refbox", port=0)
    station = BaseStation(bench.component.port)
    bench.port("game_state").put()
    bench.iterate()
    (connected,) = bench.component._stations
    assert absence_s(connected._connection) == 20.0
    station.close()
    bench.finalize()


def absence_s(connection: socket.socket) -> float:
    """Returns the time after which a connection fails whose peer says nothing, idle or while it is sent something."""
    asked, tcp = connection.getsockopt, socket.IPPROTO_TCP
    assert asked(socket.SOL_SOCKET, socket.SO_KEEPALIVE)
    idle_s = asked(tcp, socket.TCP_KEEPIDLE) + asked(tcp, socket.TCP_KEEPINTVL) * asked(tcp, socket.TCP_KEEPCNT)
    assert asked(tcp, socket.TCP_USER_TIMEOUT) == 1000 * idle_s
    return idle_s
