"""Debuggers are looked for before any process starts, and left from wherever Ctrl-C has stopped."""

import io
import os
import signal
import sys
from collections.abc import Callable, Iterator
from types import FrameType

import pytest

from fwk import Component, Writes
from fwk.engine.failures import DebuggerLeft
from fwk.host.debugger import DebuggerMissingError, DebugRequest, QuietPdb, check
from fwk.lcm.messages import decoder
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


class Session:
    """pdb that reads its lines from a text, and gets Ctrl-C."""

    def __init__(self, typed: str) -> None:
        self.output = io.StringIO()
        self.pdb = QuietPdb(nosigint=True, stdin=io.StringIO(typed), stdout=self.output)
        signal.signal(signal.SIGINT, self.pdb.on_interrupt)


@pytest.fixture
def session(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], Session]]:
    monkeypatch.setattr(os, "isatty", lambda _: True)
    before = signal.getsignal(signal.SIGINT)
    yield Session
    signal.signal(signal.SIGINT, before)


def interrupted(_: object = None) -> imu_t:
    signal.raise_signal(signal.SIGINT)
    return imu_t()


@pytest.mark.parametrize("typed", ["q\n", ""], ids=["q", "Ctrl-D"])
def test_leaving_in_a_decoder_is_no_damaged_message(
    session: Callable[[str], Session], typed: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("fwk.lcm.codec.decoder", lambda _: interrupted)
    decode = decoder(imu_t, "r/imu")
    with pytest.raises(DebuggerLeft):
        session(typed).pdb.run_quietly(lambda: decode(b""))


def test_ctrl_c_stops_in_the_code_that_runs(session: Callable[[str], Session]) -> None:
    traced = session("c\nq\n")
    with pytest.raises(DebuggerLeft):
        traced.pdb.run_quietly(lambda: [interrupted(), interrupted()])
    stops_at = "signal.raise_signal(signal.SIGINT)" if sys.version_info >= (3, 13) else "return imu_t()"
    assert traced.output.getvalue().count(f"interrupted()\n-> {stops_at}") == 2


def test_ctrl_c_in_the_debugger_stops_behind_it(session: Callable[[str], Session]) -> None:
    traced = session("q\n")
    break_anywhere = traced.pdb.break_anywhere

    def slow(frame: FrameType) -> bool:
        traced.pdb.break_anywhere = break_anywhere  # type: ignore[method-assign]
        interrupted()
        return bool(break_anywhere(frame))

    traced.pdb.break_anywhere = slow  # type: ignore[method-assign]
    with pytest.raises(DebuggerLeft):
        traced.pdb.run_quietly(lambda: imu_t())
    assert "imu_t" in traced.output.getvalue()
    assert "/bdb.py" not in traced.output.getvalue()


def test_ctrl_c_at_the_prompt_ends_the_command(session: Callable[[str], Session]) -> None:
    traced = session("interrupted()\nq\n")
    with pytest.raises(DebuggerLeft):
        traced.pdb.run_quietly(interrupted)
    assert "KeyboardInterrupt" in traced.output.getvalue()
