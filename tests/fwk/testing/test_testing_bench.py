"""The bench gives a component's ports as attributes."""

import pytest

from fwk import Component, Each, Reads, Writes
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
