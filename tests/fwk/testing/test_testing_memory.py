"""Systems in memory write the same messages however their components share hosts."""

from collections.abc import Mapping
from importlib import import_module
from pathlib import Path

import pytest

from fwk import Clock, Component, MainLoop, Reads, TimeSource, Writes
from fwk.plan.hosting import Hosting
from fwk.testing import MemorySystem
from lcmtypes.robot import imu_t
from tests.harness.components import sources
from tests.harness.runs import write_files


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


@pytest.fixture
def market(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> dict[str, type[Component]]:
    """Returns traders, imported from a folder of the test's own, as a user's project would."""
    write_files(tmp_path, sources("traders.py"))
    monkeypatch.syspath_prepend(tmp_path)
    traders = import_module("traders")
    every_trader = dict.fromkeys(["a/trader", "b/trader", "c/trader"], traders.Trader)
    return {**every_trader, "a/bystander": traders.Bystander, "d/trader": traders.Wanderer}


def sent(components: Mapping[str, type[Component]], hosting: Hosting) -> dict[str, list[bytes]]:
    channels = {"b/slow": {"state": "a/state"}} if "b/slow" in components else {}
    system = MemorySystem(components, channels=channels, hosting=hosting)
    system.tick(40)
    return system.sent


def check_hosting(components: Mapping[str, type[Component]], hosting: Hosting) -> None:
    alone = sent(components, "process")
    assert sent(components, hosting) == alone
    assert all(len(messages) > 10 for channel, messages in alone.items() if not channel.startswith("shop"))


@pytest.mark.parametrize("hosting", ["robot", "single"])
def test_every_hosting_gives_the_same_main_loop(hosting: Hosting) -> None:
    check_hosting(CONDUCTED, hosting)


@pytest.mark.parametrize("hosting", ["robot", "single"])
def test_every_hosting_gives_the_same_dynamic_channels(market: dict[str, type[Component]], hosting: Hosting) -> None:
    check_hosting(market, hosting)


def test_a_component_that_raises_is_known_in_a_shared_host() -> None:
    class Fails(Plays):
        def loop(self) -> None:
            raise ZeroDivisionError("no state")

    system = MemorySystem({"a/conducts": Conducts, "a/plays": Fails}, hosting="single")
    with pytest.raises(ZeroDivisionError, match="no state"):
        system.tick()


def test_unknown_channel_is_named_with_the_nearest() -> None:
    system = MemorySystem({"a/plays": Plays, "a/conducts": Conducts})
    with pytest.raises(KeyError, match=r"no channel 'a/stat'; did you mean 'a/state'\?"):
        system.newest("a/stat")


def test_states_and_figures_are_put_together_for_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    """In memory no supervisor listens; with many components reports took a third of the time to begin."""
    monkeypatch.setattr("fwk.bus.sync.encode_actual", {}.__getitem__)
    system = MemorySystem({"a/conducts": Conducts, "a/plays": Plays})
    system.tick(30)
    assert system.sent["a/heard"]
