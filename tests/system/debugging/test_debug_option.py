"""One component under pdb in a real terminal: all processes wait, and the recording shows no trace of it."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fwk.clock import sleep_s
from fwk.recording.compare import Comparison
from tests.harness.runs import PortBlock, write_files
from tests.harness.terminals import FILES, LOOP_LINE, Terminal

pytestmark = pytest.mark.system

Open = Callable[..., Terminal]


@pytest.fixture
def terminal(tmp_path: Path, ports: PortBlock) -> Iterator[Open]:
    write_files(tmp_path, FILES)
    opened: list[Terminal] = []

    def start(*arguments: str) -> Terminal:
        opened.append(Terminal.launch(tmp_path, ports, *arguments))
        return opened[-1]

    yield start
    for each in opened:
        each.kill()


def test_a_breakpoint_holds_all_and_leaves_no_trace(terminal: Open, tmp_path: Path) -> None:
    assert terminal("--record", "free.log").end() == 0
    debugged = terminal("--debug", "r/world_model", "--record", "stopped.log")
    assert "loop()" in debugged.prompt()
    debugged.type(f"tbreak {LOOP_LINE}")
    debugged.prompt()
    debugged.type("c")
    debugged.prompt()
    debugged.type("p self.imu.value.header.tick")
    assert "2" in debugged.prompt()
    sleep_s(0.5)
    assert debugged.turns == 2
    debugged.type("c")
    assert debugged.end() == 0
    assert debugged.turns == 40
    compared = Comparison(tmp_path / "free.log", tmp_path / "stopped.log", False)
    assert compared.difference is None
    assert compared.messages == 80


def test_quitting_the_debugger_gives_the_component_back(terminal: Open) -> None:
    debugged = terminal("--debug", "r/world_model")
    debugged.prompt()
    debugged.type("q")
    debugged.child.expect("r/world_model runs again, incarnation 2")
    assert debugged.end() == 0
    assert debugged.turns == 40


def test_ctrl_c_stops_in_the_component_and_not_the_run(terminal: Open) -> None:
    debugged = terminal("--debug", "r/world_model", "--ticks", "100000")
    debugged.prompt()
    debugged.type("c")
    while debugged.turns < 5:
        sleep_s(0.05)
    debugged.child.sendintr()
    debugged.prompt()
    before = debugged.turns
    sleep_s(0.5)
    assert debugged.turns <= before + 1
    debugged.type("q")
    debugged.child.expect("runs again")
    debugged.child.sendintr()
    assert debugged.end() == 0
