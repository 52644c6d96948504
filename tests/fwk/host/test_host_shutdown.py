"""A leaving host repeats its last messages without flooding a supervisor that is busy with other hosts."""

from itertools import pairwise

from fwk.bus.memory_network import MemoryNetwork
from fwk.bus.sender import Sender
from fwk.host.shutdown import LOCKSTEP_TIMEOUT_US, LONGEST_REPEAT_US, REPEAT_US, REPETITIONS_LEAST, Shutdown
from fwk.model.ports import Ports
from lcmtypes.core import done_t, leaving_t, taken_t
from tests.fwk.host.host_parts import plan


def leaving() -> tuple[Shutdown, MemoryNetwork, list[int], int]:
    """A host that leaves: its shutdown, network, the times at which it sends, and the gateway's number."""
    ports, sent_us = Ports.of(plan(20_000)), list[int]()
    network = MemoryNetwork(lambda _data, _address: sent_us.append(network.clock_us))
    shutdown = Shutdown(network, ports, Sender(ports.host(0), network), leaving_t(), [b"done"], LOCKSTEP_TIMEOUT_US)
    return shutdown, network, sent_us, ports.gateway


def test_repetitions_of_a_leaving_host_become_rarer() -> None:
    shutdown, network, sent_us, _ = leaving()
    for until_us in shutdown.wait(lambda: None):
        network.clock_us = until_us
    repeated_us = sorted(set(sent_us))
    waits_us = [after - before for before, after in pairwise(repeated_us)]
    assert waits_us[:3] == [REPEAT_US, 2 * REPEAT_US, 4 * REPEAT_US]
    assert max(waits_us) == LONGEST_REPEAT_US
    assert network.clock_us == LOCKSTEP_TIMEOUT_US
    assert len(sent_us) < 50


def test_a_suspended_machine_ends_no_leaving_host() -> None:
    shutdown, network, sent_us, _ = leaving()
    for until_us in shutdown.wait(lambda: None):
        network.clock_us = until_us if network.clock_us else 2 * LOCKSTEP_TIMEOUT_US
    assert len(set(sent_us)) == 1 + REPETITIONS_LEAST


def test_a_leaving_host_ends_with_the_last_answer() -> None:
    shutdown, network, sent_us, gateway = leaving()
    takers = [gateway, taken_t.SUPERVISOR]
    for until_us in shutdown.wait(lambda: None):
        network.clock_us = until_us
        shutdown.answered(taken_t(taker=takers.pop(), kind=done_t.FINAL))
    assert network.clock_us == 3 * REPEAT_US
    assert sent_us == [0, 0, REPEAT_US]
