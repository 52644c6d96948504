"""The bench gives a component's ports as attributes."""

import re
from typing import Any

import pytest

from fwk import Component, Config, Each, Field, Reads, Writes
from fwk.testing import Bench
from lcmtypes.robot import odometry_t


class Tracker(Component):
    stage = "think"
    sighting: Reads[odometry_t]
    robots: Each[Reads[odometry_t]]
    ball: Writes[odometry_t]

    def loop(self) -> None:
        self.ball.value.x_m = self.sighting.value.x_m + sum(each.value.x_m for each in self.robots.values())
        self.ball.write()


def test_ports_are_attributes() -> None:
    tracker = Bench(Tracker, namespaces=("cyan1", "cyan2"))
    tracker.sighting.put(x_m=2.0, header={"tick": 3})
    tracker.robots["cyan2"].put(x_m=0.5)
    tracker.iterate()
    assert tracker.ball.sent[-1].x_m == 2.5
    assert list(tracker.robots) == ["cyan1", "cyan2"]


def test_an_unknown_port_is_named() -> None:
    with pytest.raises(AttributeError, match="the component has no port 'bal'; its ports: sighting, robots, ball"):
        _ = Bench(Tracker).bal


class PumpConfig(Config):
    gain: float = Field(0.5, ge=0)
    rate: int


class Pump(Component):
    stage = "think"
    config: PumpConfig


@pytest.mark.parametrize(
    ("settings", "mistake"),
    [
        ({"gian": 1, "rate": 2}, "Pump: no setting 'gian'; did you mean 'gain'?"),
        ({"gain": 1}, "Pump: the setting 'rate' is missing; it has no default"),
        (
            {"gain": -1, "rate": "x"},
            "Pump: 'gain' is -1; it should be greater than or equal to 0; "
            "Pump: 'rate' is 'x'; it should be a valid integer, unable to parse string as an integer",
        ),
    ],
)
def test_a_setting_that_does_not_fit_is_a_sentence(settings: dict[str, Any], mistake: str) -> None:
    with pytest.raises(ValueError, match=f"^{re.escape(mistake)}$"):
        Bench(Pump, **settings)
