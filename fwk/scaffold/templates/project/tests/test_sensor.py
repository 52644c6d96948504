"""The sensor sees the object come closer."""

import pytest

from fwk.testing import Bench
from things.sensor import Sensor


def test_the_object_comes_closer() -> None:
    bench = Bench(Sensor, period_s=0.1, speed_m_s=2.0, noise_m=0.0)
    bench.iterate(5)
    assert bench.reading.sent[-1].range_m == pytest.approx(9.0)
