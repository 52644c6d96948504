"""The main loop as components see it, without processes."""

import pytest

from fwk import Clock, Component, MainLoop, Reads, Writes, channel
from fwk.testing.memory import MemorySystem
from lcmtypes.robot import imu_t


@pytest.mark.parametrize(
    ("order", "error"),
    [
        ([], "r/driver: a schedule has 1 to 1000 stages, not 0"),
        (["think"] * 1001, "r/driver: a schedule has 1 to 1000 stages, not 1001"),
        (["think", "thikn"], "r/driver: no stage 'thikn'; the stages are think, act"),
    ],
)
def test_an_impossible_order_is_refused_at_once(order: list[str], error: str) -> None:
    main_loop = MainLoop("r/driver", ("think", "act"))
    with pytest.raises(ValueError, match=error):
        main_loop.take_over(order)
    assert main_loop._take() is None


def test_an_order_of_unknown_or_no_stages_is_a_mistake() -> None:
    loop = MainLoop("r/a", ["think", "act"])
    with pytest.raises(ValueError, match="r/a: no stage 'thnk'; the stages are think, act"):
        loop.take_over(["act", "thnk"])
    with pytest.raises(ValueError, match="1 to 1000 stages, not 0"):
        loop.take_over([])
    assert loop._take() is None


class Conducts(Component):
    """Sets another order for three ticks."""

    stage = "think"
    clock: Clock
    main_loop: MainLoop
    state: Writes[imu_t]

    def loop(self) -> None:
        self.state.value.heading_rad = self.main_loop.mine
        self.state.write()
        if self.clock.tick == 2 and not self.main_loop.mine:
            self.main_loop.take_over(["act", "think", "act"])
        if self.clock.tick == 5:
            self.main_loop.give_back()


class Plays(Component):
    stage = "act"
    other: Reads[imu_t] = channel("r/state")
    heard: Writes[imu_t]

    def loop(self) -> None:
        self.heard.value.heading_rad = self.other.header.tick
        self.heard.write()


def test_a_system_in_memory_runs_the_requested_stages() -> None:
    system = MemorySystem({"r/conducts": Conducts, "r/plays": Plays})
    system.tick(7)
    played = [imu_t.decode(data) for data in system.sent["r/heard"]]
    assert [(imu.header.tick, imu.header.stage, imu.heading_rad) for imu in played] == [
        (1, 7, 1),
        (2, 7, 2),
        *((tick, place, tick - (place == 0)) for tick in (3, 4, 5) for place in (0, 2)),
        (6, 7, 6),
        (7, 7, 7),
    ]
    states = [imu_t.decode(data) for data in system.sent["r/state"]]
    assert [bool(state.heading_rad) for state in states] == [False, False, True, True, True, False, False]
