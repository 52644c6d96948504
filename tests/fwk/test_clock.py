"""Time sources refuse impossible times where they are set."""

from typing import Any

import numpy as np
import pytest

from fwk import Component, TimeSource
from fwk.testing import Bench


class Sun(Component):
    stage = "pre_loop"
    time_source: TimeSource


@pytest.mark.parametrize("value", [-1, 2**63, 2.5e6, float("nan"), "soon", None])
def test_an_impossible_time_is_refused(value: Any) -> None:
    source = Bench(Sun).component.time_source
    with pytest.raises(ValueError, match=r"next_us is .*; it should be whole microseconds, from 0 to 10{18}"):
        source.next_us = value
    assert source.next_us == -1


def test_whole_numbers_of_any_kind_are_taken() -> None:
    source = Bench(Sun).component.time_source
    source.next_us = np.int64(70_000)
    assert source.next_us == 70_000
    assert type(source.next_us) is int
