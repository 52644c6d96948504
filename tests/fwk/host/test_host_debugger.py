"""Debuggers are looked for before any process starts."""

import sys

import pytest

from fwk import Component, Writes
from fwk.host.debugger import DebuggerMissingError, DebugRequest, check
from fwk.testing.plans import plan_of
from lcmtypes.robot import imu_t


class Senses(Component):
    stage = "sensor_acquire"
    imu: Writes[imu_t]


def test_missing_debugger_is_named_with_the_command_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "debugpy", None)
    component = plan_of({"r/senses": Senses}).components[0]
    with pytest.raises(DebuggerMissingError, match=r"pip install 'fwk\[debugpy\]'"):
        check(DebugRequest(0, component, debugpy_port=5678))
