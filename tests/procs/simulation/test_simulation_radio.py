"""The radio: receivers, delay, loss, and equal results with equal seeds."""

import itertools
from typing import Any

import numpy as np
import pytest

from fwk.testing import Bench
from lcmtypes.soccer import obstacle_t, team_message_t
from procs.model.realism import Realism
from procs.simulation.radio import Radio

TEAM = ("cyan1", "cyan2", "cyan3", "cyan4", "cyan5")


def radio(seed: int = 1, **settings: float) -> Bench:
    links: dict[str, Any] = {"loss": 0.0, "delay_s": 0.0, "delay_jitter_s": 0.0, "realism": "none", **settings}
    return Bench(Radio, "team_cyan/radio", seed, namespaces=TEAM, **links)


def say(bench: Bench, robot: str, period_us: int = 50_000, **members: Any) -> None:
    """Sends the tick from the robot."""
    message = team_message_t(**members)
    message.robot = robot
    message.header.tick = bench.tick + 1
    message.header.time_us = bench.time_us + period_us
    bench.port("messages", robot).put(message)


def test_every_mate_receives_it_and_the_sender_does_not() -> None:
    bench = radio()
    say(bench, "cyan2")
    say(bench, "cyan4")
    bench.iterate()
    heard = {robot: [m.robot for sent in bench.port("inboxes", robot).sent for m in sent.messages] for robot in TEAM}
    assert heard == {
        "cyan1": ["cyan2", "cyan4"],
        "cyan2": ["cyan4"],
        "cyan3": ["cyan2", "cyan4"],
        "cyan4": ["cyan2"],
        "cyan5": ["cyan2", "cyan4"],
    }


def test_silence_writes_nothing() -> None:
    bench = radio()
    say(bench, "cyan1")
    bench.iterate(5)
    assert [len(bench.port("inboxes", robot).sent) for robot in TEAM] == [0, 1, 1, 1, 1]


def test_message_arrives_as_it_was_sent() -> None:
    bench = radio(delay_s=0.1)
    bench.iterate(3)
    say(bench, "cyan1")
    bench.iterate(5)
    (inbox,) = bench.port("inboxes", "cyan5").sent
    assert (inbox.n, inbox.messages[0].header.tick, inbox.messages[0].header.time_us) == (1, 4, 200_000)
    assert inbox.header.tick == 5, "a robot reads it in tick 6, 0.1 s after tick 4"


@pytest.mark.parametrize(("delay_s", "ticks"), [(0.0, 1), (0.02, 1), (0.05, 1), (0.06, 2), (0.1, 2)])
def test_robots_read_in_the_first_tick_after_arrival(delay_s: float, ticks: int) -> None:
    bench = radio(delay_s=delay_s)
    say(bench, "cyan1")
    sent = bench.tick + 1
    bench.iterate(5)
    (inbox,) = bench.port("inboxes", "cyan2").sent
    assert inbox.header.tick + 1 - sent == ticks


@pytest.mark.slow
@pytest.mark.parametrize("loss", [0.0, 0.03, 0.3, 1.0])
def test_each_link_loses_that_share_independently(loss: float) -> None:
    bench = radio(loss=loss)
    ticks = 400
    for _ in range(ticks):
        for robot in TEAM:
            say(bench, robot)
        bench.iterate()
    heard = np.zeros((5, 5))
    for listener, robot in enumerate(TEAM):
        for sent in bench.port("inboxes", robot).sent:
            for message in sent.messages:
                heard[TEAM.index(message.robot), listener] += 1
    links = heard[~np.eye(5, dtype=bool)] / ticks
    deviation = np.sqrt(loss * (1 - loss) / ticks)
    assert np.abs(links - (1 - loss)).max() <= 4 * deviation
    assert abs(links.mean() - (1 - loss)) <= 4 * deviation / np.sqrt(20)
    assert len(set(links.tolist())) > 1 or loss in (0.0, 1.0), "links are independent"


def test_delay_lies_between_the_least_and_the_jitter_on_top() -> None:
    bench = radio(delay_s=0.08, delay_jitter_s=0.2)
    for _ in range(300):
        say(bench, "cyan1")
        bench.iterate()
    delays_s = [
        (sent.header.time_us - message.header.time_us) / 1e6 + 0.05  # robots read in the tick after the inbox
        for sent in bench.port("inboxes", "cyan2").sent
        for message in sent.messages
    ]
    assert min(delays_s) == pytest.approx(0.1), "the first tick after 0.08 s"
    assert max(delays_s) == pytest.approx(0.3)
    assert np.mean(delays_s) == pytest.approx(0.08 + 0.1 + 0.025, abs=0.02)


@pytest.mark.parametrize(
    ("realism", "late"), [("none", 0.0), ("friendly", 0.0), ("realistic", 0.0), ("harsh", 10.0 / 40.0)]
)
def test_share_of_messages_that_a_robot_reads_a_tick_late(realism: Realism, late: float) -> None:
    """Only the `harsh` radio takes longer than a tick of 40 ms: 10 to 50 ms."""
    bench = Bench(Radio, "team_cyan/radio", 1, 0.04, TEAM, realism=realism)
    for tick in range(1500):
        if tick % 2 == 0:
            for robot in TEAM:
                say(bench, robot, period_us=40_000)
        bench.iterate()
    ages_us = [
        inbox.header.time_us - message.header.time_us
        for robot in TEAM
        for inbox in bench.port("inboxes", robot).sent
        for message in inbox.messages
    ]
    assert np.mean(np.array(ages_us) > 0) == pytest.approx(late, abs=0.04)


def test_same_seed_gives_the_same_radio_and_another_differs() -> None:
    def run(seed: int) -> list[bytes]:
        bench = radio(seed, loss=0.3, delay_jitter_s=0.2)
        for _ in range(50):
            for robot in TEAM:
                say(bench, robot)
            bench.iterate()
        return [sent.encode() for robot in TEAM for sent in bench.port("inboxes", robot).sent]

    assert run(1) == run(1)
    assert run(1) != run(2)


def test_one_changed_setting_keeps_the_other_random_draws() -> None:
    def lost(delay_s: float) -> list[int]:
        bench = radio(loss=0.3, delay_s=delay_s)
        for _ in range(40):
            say(bench, "cyan1")
            bench.iterate()
        bench.iterate(10)
        return [m.header.tick for sent in bench.port("inboxes", "cyan2").sent for m in sent.messages]

    assert lost(0.0) == lost(0.2)


def test_interrupted_links_lose_messages_in_a_row() -> None:
    bench = radio(outages_1_min=6.0, outage_s=1.0)
    for _ in range(1200):
        say(bench, "cyan1")
        bench.iterate()
    heard = {message.header.tick for sent in bench.port("inboxes", "cyan2").sent for message in sent.messages}
    lost = sorted(set(range(1, 1201)) - heard)
    runs = sum(later - earlier > 1 for earlier, later in itertools.pairwise(lost)) + 1
    assert 0.03 < len(lost) / 1200 < 0.2
    assert len(lost) / runs > 8


def test_an_interruption_does_not_end_because_another_begins() -> None:
    """With five a second, each of a second on average, hardly one message in 150 meets none: exp(-5)."""
    bench = radio(outages_1_min=300.0, outage_s=1.0)
    for _ in range(1200):
        say(bench, "cyan1")
        bench.iterate()
    heard = sum(len(sent.messages) for robot in TEAM for sent in bench.port("inboxes", robot).sent)
    assert heard / (4 * 1200) < 0.03


@pytest.mark.parametrize("realism", ["friendly", "realistic", "harsh"])
def test_longest_messages_arrive_like_the_shortest(realism: Realism) -> None:
    """A team that sends ten times a second is far from the limit of the channel."""

    def arrivals(*obstacles: obstacle_t) -> list[tuple[str, int, str, int]]:
        bench = Bench(Radio, "team_cyan/radio", 1, namespaces=TEAM, realism=realism)
        for _ in range(100):
            for robot in TEAM if bench.tick % 2 else ():
                say(bench, robot, obstacles=list(obstacles))
            bench.iterate()
        inboxes = {robot: bench.port("inboxes", robot).sent for robot in TEAM}
        return [
            (robot, inbox.header.tick, message.robot, message.header.tick)
            for robot, sent in inboxes.items()
            for inbox in sent
            for message in inbox.messages
        ]

    assert arrivals(*[obstacle_t()] * 9) == arrivals()
    assert arrivals()


def test_narrow_channel_loses_what_is_beyond_it() -> None:
    bench = radio(bandwidth_bit_s=40_000.0)
    size_bits = 8 * len(team_message_t().encode())
    for _ in range(200):
        for robot in TEAM:
            say(bench, robot)
        bench.iterate()
    sent = {m.header.tick for each in bench.port("inboxes", "cyan1").sent for m in each.messages}
    heard = sum(len(each.messages) for robot in TEAM for each in bench.port("inboxes", robot).sent) / 4
    assert heard * size_bits == pytest.approx(40_000 * (10 + 0.2), rel=0.1)
    assert sent


def test_very_narrow_channel_passes_what_it_can() -> None:
    """A message that takes longer than a fifth of a second passes, too, and the channel is busy as long as it takes."""
    size_bits = 8 * len(team_message_t().encode())
    bench = radio(bandwidth_bit_s=2.0 * size_bits)
    for _ in range(400):
        say(bench, "cyan1")
        bench.iterate()
    assert len(bench.port("inboxes", "cyan2").sent) == pytest.approx(2.0 * 20, abs=2)


def test_robots_share_a_narrow_channel_evenly() -> None:
    bench = radio(bandwidth_bit_s=40_000.0)
    for _ in range(400):
        for robot in TEAM:
            say(bench, robot)
        bench.iterate()
    said = [m.robot for robot in TEAM for each in bench.port("inboxes", robot).sent for m in each.messages]
    counts = [said.count(robot) for robot in TEAM]
    assert min(counts) > 0.9 * max(counts) > 0
