"""Failures name the component, its source line and the moment."""

from pathlib import Path

import pytest

from fwk.clock import Clock
from fwk.component.log import Logger
from fwk.engine.failures import ComponentFailedError, Failures
from fwk.engine.metrics import ComponentMetrics
from fwk.lcm import messages
from lcmtypes.core import header_t


def test_value_that_fits_no_message_is_attributed_to_its_line() -> None:
    metrics = {"r/probe": ComponentMetrics("r/probe", lambda: 0)}
    failures = Failures(metrics, 0.0, lambda: None, Logger("r/probe", Clock(), lambda _: None))
    header = header_t()
    header.tick = "one"  # type: ignore[assignment]
    with pytest.raises(ComponentFailedError) as failed, failures.guard("r/probe", "loop, tick 1"):
        messages.encode(header, "r/probe")
    assert f"({Path(__file__)}:" in str(failed.value)
    assert f"({Path(__file__)}:" in metrics["r/probe"].reason
