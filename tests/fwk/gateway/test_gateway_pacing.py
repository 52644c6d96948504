"""The gateway publishes in small groups, in order, within a tick, at the rate that listeners handle."""

from collections.abc import Callable

import pytest

from fwk.gateway.pacing import LARGEST, LEAST, LONGEST_US, QUEUE_MAX, SLOT_BYTES, SLOT_US, PacedPublisher

TICK_US = 50_000
PATIENCE_US = 400_000


class Paced:
    """A publisher on a clock that the test moves; `groups` holds the number of datagrams sent at once."""

    def __init__(self) -> None:
        self.now_us = 1_000_000
        self.sent: list[bytes] = []
        self.groups: list[int] = []
        self.busy: str | None = ""
        self.others: list[str] = []
        self.publisher = PacedPublisher(lambda: self.now_us, self.sent.append, self.busy_listeners, PATIENCE_US)

    def busy_listeners(self) -> list[str] | None:
        return None if self.busy is None else [*filter(None, (self.busy,)), *self.others]

    def tick(self, count: int, datagram: Callable[[int], bytes] = lambda number: b"%d" % number) -> None:
        """Ends a tick in which so many datagrams were written."""
        self.publisher.put(datagram(number) for number in range(count))
        self.publisher.tick()

    def pass_time(self, duration_us: int) -> None:
        """Lets time pass; calls the publisher at the times that it requests."""
        end_us = self.now_us + duration_us
        while max(self.publisher.due_us, self.now_us) < end_us:
            self.now_us = max(self.publisher.due_us, self.now_us)
            before = len(self.sent)
            self.publisher.send_due()
            self.groups.append(len(self.sent) - before)
        self.now_us = end_us


def test_a_tick_leaves_in_small_groups_within_a_tick() -> None:
    paced = Paced()
    for tick in range(1, 21):
        paced.tick(200)
        paced.pass_time(TICK_US)
        assert len(paced.sent) == 200 * tick
    assert max(paced.groups) <= LARGEST
    assert paced.sent[:200] == [b"%d" % number for number in range(200)]


def test_many_ticks_at_once_leave_in_groups_of_bounded_size() -> None:
    paced = Paced()
    for _ in range(16):
        paced.tick(200)
    paced.pass_time(16 * 200 // LARGEST * SLOT_US + 2 * SLOT_US)
    assert len(paced.sent) == 16 * 200
    assert max(paced.groups) <= LARGEST


def test_a_late_gateway_sends_one_group() -> None:
    paced = Paced()
    paced.tick(1000)
    paced.pass_time(SLOT_US)
    paced.now_us += 100 * SLOT_US
    before = len(paced.sent)
    paced.publisher.send_due()
    assert len(paced.sent) - before <= LARGEST


def test_a_busy_listener_holds_the_next_group_back() -> None:
    paced = Paced()
    paced.tick(100)
    paced.busy = "lcm-logger"
    paced.pass_time(PATIENCE_US - SLOT_US)
    assert paced.sent == []
    assert paced.publisher.overrun == ""
    paced.busy = ""
    paced.pass_time(2 * SLOT_US)
    assert LEAST <= len(paced.sent) <= 2 * LARGEST


def test_a_listener_that_stays_busy_is_overrun_and_named() -> None:
    paced = Paced()
    paced.tick(100)
    paced.busy = "lcm-logger"
    paced.pass_time(2 * PATIENCE_US)
    assert len(paced.sent) == 100
    assert max(paced.groups) <= LARGEST
    assert paced.publisher.overrun == "lcm-logger"


def test_listener_that_stays_busy_takes_nothing_from_the_others() -> None:
    paced = Paced()
    paced.tick(200)
    paced.busy = "lcm-spy"
    paced.pass_time(PATIENCE_US + 3 * SLOT_US)
    paced.others = ["lcm-logger"]
    paced.pass_time(2 * SLOT_US)
    sent = len(paced.sent)
    paced.pass_time(PATIENCE_US // 2)
    assert (len(paced.sent), paced.publisher.overrun) == (sent, "lcm-spy")
    paced.others = []
    paced.pass_time(200 * SLOT_US)
    assert len(paced.sent) == 200
    assert max(paced.groups) <= LARGEST


def test_the_rest_leaves_at_once_at_the_end() -> None:
    paced = Paced()
    paced.tick(100)
    paced.busy = "lcm-logger"
    paced.publisher.send_all()
    assert len(paced.sent) == 100
    assert paced.publisher.waiting == 0
    assert paced.publisher.overrun == "lcm-logger"


def test_nothing_is_sent_while_no_program_can_listen() -> None:
    paced = Paced()
    paced.busy = None
    paced.tick(1000)
    paced.publisher.send_due()
    assert (paced.sent, paced.publisher.waiting, paced.publisher.unheard) == ([], 0, True)


def test_a_program_that_begins_to_listen_is_noticed() -> None:
    paced = Paced()
    paced.busy = None
    paced.tick(10)
    paced.publisher.send_due()
    paced.busy = ""
    paced.publisher.send_due()
    assert not paced.publisher.unheard
    paced.tick(10)
    paced.pass_time(TICK_US)
    assert paced.sent == [b"%d" % number for number in range(10)]


def test_large_datagrams_count_as_several() -> None:
    paced = Paced()
    paced.tick(100, lambda _: bytes(10 * SLOT_BYTES))
    paced.pass_time(SLOT_US)
    assert len(paced.sent) <= 2


def test_datagrams_beyond_the_queue_leave_at_once() -> None:
    paced = Paced()
    paced.tick(QUEUE_MAX + 1000)
    paced.publisher.send_due()
    assert paced.publisher.waiting == QUEUE_MAX


@pytest.mark.parametrize("count", [1, 5])
def test_a_few_messages_leave_at_once(count: int) -> None:
    paced = Paced()
    paced.tick(count)
    paced.pass_time(2 * SLOT_US)
    assert len(paced.sent) == count
    assert paced.publisher.due_us > paced.now_us + LONGEST_US
