"""The simulated world itself: time, datagrams, processes that die and stop, the same history from one seed."""

from collections.abc import Generator
from functools import partial
from itertools import pairwise
from pathlib import Path

import pytest

from fwk.bus.sockets import GROUP, LOOPBACK
from tests.simulation.faults import Action, Weather
from tests.simulation.network import Ether
from tests.simulation.process import Process
from tests.simulation.scenario import Part, Scenario, scenario_of
from tests.simulation.shrink import shrink
from tests.simulation.system import run
from tests.simulation.trace import Trace
from tests.simulation.world import START_US, StuckError, World

PORT = 100


class Pair:
    """A process that sends `count` datagrams, one a millisecond, and one that receives them."""

    def __init__(self, weather: Weather = Weather(), count: int = 100) -> None:  # noqa: B008 - immutable
        self.world = World(1, weather, Trace(False))
        self.ether = Ether(self.world)
        self.heard: list[tuple[bytes, int]] = []
        self.codes: list[int] = []
        self._count = count
        self.sender = Process("sender", self.world, self.ether, self.codes.append)
        self.hearer = Process("hearer", self.world, self.ether, self.codes.append)
        self.hearer.start(self._hear)
        self.sender.start(self._send)

    def run(self, time_us: int) -> None:
        """Lets that wall time pass."""
        self.world.at(START_US + time_us, lambda: None)
        self.world.run(lambda: self.world.now_us >= START_US + time_us, time_us + 1)

    def _send(self) -> Generator[int, list[int], None]:
        socket = self.sender.own_socket(1)
        for number in range(self._count):
            yield self.sender.now_us() + 1000
            socket.sendto(bytes([number]), (GROUP, PORT))
            socket.sendto(b"", (LOOPBACK, 77))  # no socket exists yet

    def _hear(self) -> Generator[int, list[int], None]:
        socket = self.hearer.group_socket(PORT)
        self.hearer.watch(socket)
        while True:
            yield self.hearer.now_us() + 10_000_000
            try:
                while True:
                    self.heard.append((socket.recvfrom(1000)[0], self.hearer.now_us()))
            except BlockingIOError:
                pass


def numbers(pair: Pair) -> list[int]:
    """Returns which datagrams were received, in order."""
    return [data[0] for data, _ in pair.heard]


def test_datagrams_arrive_in_order() -> None:
    pair = Pair()
    pair.run(200_000)
    assert numbers(pair) == list(range(100))
    assert pair.codes == [0]


def test_datagrams_are_lost() -> None:
    pair = Pair(Weather(loss=0.5))
    pair.run(200_000)
    assert 20 < len(pair.heard) < 80
    assert pair.ether.lost == 100 - len(pair.heard)


def test_datagrams_are_duplicated() -> None:
    pair = Pair(Weather(duplicate=0.5))
    pair.run(200_000)
    assert 120 < len(pair.heard) < 180
    assert set(numbers(pair)) == set(range(100))


def test_delayed_datagrams_are_overtaken() -> None:
    pair = Pair(Weather(delay=0.5, delay_us=50_000))
    pair.run(300_000)
    assert sorted(numbers(pair)) == list(range(100)) != numbers(pair)


def test_killed_process_sends_nothing_more() -> None:
    pair = Pair()
    pair.sender.kill_at_send(21)  # every second datagram has no receiver
    pair.run(200_000)
    assert numbers(pair) == list(range(10))
    assert pair.codes == [-9]


def test_stopped_process_continues_where_it_was() -> None:
    pair = Pair()
    pair.world.at(START_US + 50_500, partial(pair.sender.stand_still, 1_000_000))
    pair.run(1_500_000)
    assert numbers(pair) == list(range(100))
    times = [time_us for _, time_us in pair.heard]
    assert max(b - a for a, b in pairwise(times)) > 990_000


def test_stop_in_the_middle_of_a_step_delays_the_rest() -> None:
    pair = Pair(count=3)
    pair.sender.stand_still_at_send(3, 500_000)  # the second datagram
    pair.run(1_000_000)
    assert numbers(pair) == [0, 1, 2]
    assert pair.heard[0][1] < START_US + 5_000
    assert pair.heard[1][1] > START_US + 500_000


def test_jump_of_the_clock_makes_waits_end() -> None:
    pair = Pair()
    pair.world.at(START_US + 10_500, partial(pair.world.jump, 60_000_000))
    pair.run(61_000_000)
    assert numbers(pair) == list(range(100))


def test_world_without_an_end_is_stuck() -> None:
    pair = Pair()
    with pytest.raises(StuckError, match="no end after"):
        pair.world.run(lambda: False, 1_000_000)


@pytest.mark.parametrize("seed", [3, 5, 8])
def test_one_seed_gives_one_history(tmp_path: Path, seed: int) -> None:
    histories = []
    for _ in range(2):
        trace = Trace(True)
        run(scenario_of(seed), tmp_path, trace)
        histories.append(list(trace.lines(START_US)))
    assert histories[0] == histories[1]
    assert len(histories[0]) > 50


def test_shrinking_keeps_what_matters() -> None:
    parts = tuple(Part(f"a{number}/player", "Player", settings={"bursts": 3}) for number in range(4))
    actions = tuple(Action("stop", 1, 100, f"a{number}/player", 1000) for number in range(4))
    big = Scenario(1, 30, parts, weather=Weather(loss=0.1, delay=0.2), actions=actions)

    def fails(scenario: Scenario) -> bool:
        stopped = {action.target for action in scenario.actions}
        return scenario.ticks >= 3 and scenario.weather.loss > 0 and "a2/player" in stopped

    small = shrink(big, fails)
    assert [part.name for part in small.parts] == ["a2/player"]
    assert (small.ticks, small.weather) == (3, Weather(loss=0.1))
    assert [action.target for action in small.actions] == ["a2/player"]


@pytest.mark.parametrize(("reached_port", "heard"), [(PORT, 10), (PORT + 1, 0)])
def test_a_process_without_network_reaches_one_port(reached_port: int, heard: int) -> None:
    pair = Pair()
    pair.sender.cut_off(reached_port)
    pair.sender.kill_at_send(21)  # every second datagram has no receiver
    pair.run(200_000)
    assert numbers(pair) == list(range(heard))
    assert pair.codes == [-9]
