"""Systems in memory write the same messages however their components share hosts."""

from collections.abc import Mapping

import pytest

from fwk import Clock, Component, MainLoop, Reads, TimeSource, Writes
from fwk.plan.hosting import Hosting
from fwk.testing import MemorySystem
from lcmtypes.robot import imu_t
from traders import Bystander, Trader, Wanderer


class Conducts(Component):
    """Sets another order of the stages for three ticks, and another time for each."""

    stage = "think"
    clock: Clock
    main_loop: MainLoop
    time_source: TimeSource
    state: Writes[imu_t]

    def loop(self) -> None:
        self.state.value.heading_rad = self.clock.now_us
        self.state.write()
        self.time_source.next_us = self.clock.now_us + 50_000 + 1_000 * self.clock.tick
        if self.clock.tick == 2 and not self.main_loop.mine:
            self.main_loop.take_over(["act", "think", "act"])
        if self.clock.tick == 5:
            self.main_loop.give_back()


class Plays(Component):
    """Writes what it reads, in two stages."""

    stage = ("sensor_process", "act")
    state: Reads[imu_t]
    heard: Writes[imu_t]

    def loop(self) -> None:
        self.heard.value.heading_rad += sum(each.heading_rad for each in self.state.fresh)
        self.heard.write()


class Slow(Plays):
    """Does the same at a rate of its own."""

    stage = ()  # type: ignore[assignment]
    rate_hz = 7.0


CONDUCTED = {"a/conducts": Conducts, "a/plays": Plays, "b/slow": Slow}
MARKET = {"a/trader": Trader, "b/trader": Trader, "c/trader": Trader, "a/bystander": Bystander, "d/trader": Wanderer}


def sent(components: Mapping[str, type[Component]], hosting: Hosting) -> dict[str, list[bytes]]:
    channels = {"b/slow": {"state": "a/state"}} if "b/slow" in components else {}
    system = MemorySystem(components, channels=channels, hosting=hosting)
    system.tick(40)
    return system.sent


@pytest.mark.parametrize("hosting", ["robot", "single"])
@pytest.mark.parametrize("components", [CONDUCTED, MARKET], ids=["main loop", "dynamic channels"])
def test_every_hosting_gives_the_same_messages(components: Mapping[str, type[Component]], hosting: Hosting) -> None:
    alone = sent(components, "process")
    assert sent(components, hosting) == alone
    assert all(len(messages) > 10 for channel, messages in alone.items() if not channel.startswith("shop"))


def test_a_component_that_raises_is_known_in_a_shared_host() -> None:
    class Fails(Plays):
        def loop(self) -> None:
            raise ZeroDivisionError("no state")

    system = MemorySystem({"a/conducts": Conducts, "a/plays": Fails}, hosting="single")
    with pytest.raises(ZeroDivisionError, match="no state"):
        system.tick()
