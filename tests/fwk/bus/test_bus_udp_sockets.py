"""UDP sockets and their owners, as the kernel shows them."""

import os
import socket
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from fwk.bus import udp_sockets
from fwk.bus.udp_sockets import UdpSocket, owners, process_name, sockets_on


@pytest.fixture
def bound() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.bind(("127.0.0.1", 0))
        yield made


@pytest.fixture(params=["asked", "table"])
def way(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Finds sockets by a question to the kernel, or in the table of kernels that do not answer."""
    if request.param == "table":
        monkeypatch.setattr(udp_sockets, "_SOCK_DIAG", 99)


def only_socket(bound: socket.socket) -> UdpSocket:
    (found,) = sockets_on(bound.getsockname()[1])
    return found


@pytest.mark.usefixtures("way")
def test_a_socket_is_found_with_its_user_and_inode(bound: socket.socket) -> None:
    inode = os.fstat(bound.fileno()).st_ino
    assert only_socket(bound) == UdpSocket(str(inode), str(os.getuid()), waiting=False)


@pytest.mark.usefixtures("way")
@pytest.mark.parametrize("address", ["::", "::1", "::ffff:127.0.0.1"])
def test_a_socket_of_ipv6_is_found_with_its_datagrams(address: str) -> None:
    with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as bound:
        bound.setsockopt(socket.IPPROTO_IPV6, socket.IPV6_V6ONLY, 0)
        bound.bind((address, 0))
        inode, user = str(os.fstat(bound.fileno()).st_ino), str(os.getuid())
        assert only_socket(bound) == UdpSocket(inode, user, waiting=False)
        with socket.socket(socket.AF_INET6, socket.SOCK_DGRAM) as sender:
            sender.sendto(b"work", bound.getsockname())
        assert only_socket(bound) == UdpSocket(inode, user, waiting=True)


def test_a_socket_that_one_reading_misses_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    row = "  9: 0100007F:1388 00000000:0000 07 00000000:00000000 00:00000000 00000000  1000 0 4711 2 0 0"
    readings = iter(["  sl  local_address", row])
    monkeypatch.setattr(udp_sockets, "_SOCK_DIAG", 99)
    monkeypatch.setattr(udp_sockets, "_TABLES", (SimpleNamespace(read_text=lambda: next(readings)),))
    assert sockets_on(5000) == [UdpSocket("4711", "1000", waiting=False)]


@pytest.mark.usefixtures("way")
def test_a_datagram_that_waits_is_seen_until_it_is_read(bound: socket.socket) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.sendto(b"work", bound.getsockname())
    assert only_socket(bound).waiting
    bound.recv(100)
    assert not only_socket(bound).waiting


@pytest.mark.usefixtures("way")
def test_many_sockets_of_one_port_are_all_found() -> None:
    made = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(300)]
    port = 0
    for each in made:
        each.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        each.bind(("127.0.0.1", port))
        port = each.getsockname()[1]
    inodes = {str(os.fstat(each.fileno()).st_ino) for each in made}
    found = sockets_on(port)
    for each in made:
        each.close()
    assert {each.inode for each in found} == inodes
    assert len(found) == len(inodes)


@pytest.mark.usefixtures("way")
def test_a_free_port_has_no_sockets(bound: socket.socket) -> None:
    port = bound.getsockname()[1]
    bound.close()
    assert sockets_on(port) == []


def test_both_ways_find_the_same(bound: socket.socket) -> None:
    port = bound.getsockname()[1]
    assert list(udp_sockets._asked_for(port, socket.AF_INET)) == list(udp_sockets._in_table(port))


def test_the_owner_of_a_socket_is_this_process(bound: socket.socket) -> None:
    inode = only_socket(bound).inode
    assert list(owners([inode])) == [(inode, os.getpid())]
    assert process_name(os.getpid()) != ""
