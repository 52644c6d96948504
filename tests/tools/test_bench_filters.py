"""Speed of the world model's filters beside those of filterpy."""

from collections.abc import Callable

import pytest

from tools.bench.filters import Step, library_ball, library_robots, microseconds_of, own_ball, own_robots


@pytest.mark.parametrize("make", [own_ball, library_ball, own_robots, library_robots])
def test_filter_has_its_cpu_time(make: Callable[[], Step]) -> None:
    assert microseconds_of(make(), ticks=20) > 0
