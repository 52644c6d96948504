import os

from fwk.bus.network import Steps, UdpNetwork
from fwk.bus.sockets import GROUP, LOOPBACK
from tests.harness.runs import PortBlock

MS = 1000


def test_participant_wakes_for_a_datagram_or_at_its_time(ports: PortBlock) -> None:
    network = UdpNetwork()
    heard, sender = network.group_socket(ports.bus), network.own_socket(ports.bus + 1)
    network.watch(heard)

    def participant() -> Steps[list[bytes]]:
        found = []
        assert (yield network.now_us() + 20 * MS) == []
        sender.sendto(b"hello", (GROUP, ports.bus))
        ready = yield network.now_us() + 60_000 * MS
        assert ready == [heard.fileno()]
        data, address = heard.recvfrom(100)
        assert address == (LOOPBACK, ports.bus + 1)
        found.append(data)
        return found

    assert network.run(participant()) == [b"hello"]
    network.close()
    heard.close()
    sender.close()


def test_unwatched_source_wakes_no_participant(ports: PortBlock) -> None:
    network = UdpNetwork()
    heard, sender = network.group_socket(ports.bus), network.own_socket(ports.bus + 1)
    network.watch(heard)
    network.unwatch(heard)
    sender.sendto(b"hello", (GROUP, ports.bus))

    def participant() -> Steps[list[int]]:
        ready = yield network.now_us() + 20 * MS
        return ready

    assert network.run(participant()) == []
    network.close()
    heard.close()
    sender.close()


def test_signal_ends_one_wait_and_not_those_after_it() -> None:
    network = UdpNetwork()
    wakeup, written_by_python = os.pipe()
    network.watch_wakeup(wakeup)
    os.write(written_by_python, b"\x0a")  # a signal that a component handles itself, not a request to stop

    def participant() -> Steps[list[list[int]]]:
        woken = []
        for _ in range(2):
            woken.append((yield network.now_us() + 20 * MS))
        return woken

    assert network.run(participant()) == [[wakeup], []]
    network.close()
    os.close(wakeup)
    os.close(written_by_python)
