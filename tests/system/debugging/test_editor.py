"""One component under debugpy, attached as by an editor: all processes wait at its breakpoint."""

import itertools
import json
import socket
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.harness.fixtures import Launch
from tests.harness.logs import difference
from tests.harness.runs import TIMEOUT_S, PortBlock, write_files
from tests.harness.terminals import FILES, LOOP_LINE, Terminal
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system

NAME = "r/world_model"


class Editor:
    """The part of the debug adapter protocol that an editor needs for a breakpoint."""

    def __init__(self, port: int) -> None:
        self._socket = socket.create_connection(("127.0.0.1", port), TIMEOUT_S)
        self._stream = self._socket.makefile("rb")
        self._numbers = itertools.count(1)
        self._events: list[dict[str, Any]] = []

    def attach(self, file: Path, line: int) -> None:
        self._ask("initialize", adapterID="test", pathFormat="path")
        attaching = self._send("attach", justMyCode=False)
        self.event("initialized")
        self._ask("setBreakpoints", source={"path": str(file)}, breakpoints=[{"line": line}])
        self._ask("configurationDone")
        self._answer(attaching)

    def stopped(self) -> int:
        """Waits for the breakpoint; returns the thread that stopped there."""
        return int(self.event("stopped")["body"]["threadId"])

    def evaluate(self, thread: int, expression: str) -> str:
        frame = self._ask("stackTrace", threadId=thread)["body"]["stackFrames"][0]["id"]
        return str(self._ask("evaluate", expression=expression, frameId=frame)["body"]["result"])

    def go_on(self, file: Path, thread: int) -> None:
        """Removes the breakpoint and disconnects."""
        self._ask("setBreakpoints", source={"path": str(file)}, breakpoints=[])
        self._ask("continue", threadId=thread)
        self._ask("disconnect")
        self._socket.close()

    def event(self, name: str) -> dict[str, Any]:
        while True:
            for event in self._events:
                if event["event"] == name:
                    self._events.remove(event)
                    return event
            self._take()

    def _ask(self, command: str, **arguments: Any) -> dict[str, Any]:
        return self._answer(self._send(command, **arguments))

    def _send(self, command: str, **arguments: Any) -> int:
        number = next(self._numbers)
        message = {"seq": number, "type": "request", "command": command, "arguments": arguments}
        data = json.dumps(message).encode()
        self._socket.sendall(b"Content-Length: %d\r\n\r\n%s" % (len(data), data))
        return number

    def _answer(self, number: int) -> dict[str, Any]:
        while True:
            message = self._take()
            if message["type"] == "response" and message["request_seq"] == number:
                assert message["success"], message
                return message

    def _take(self) -> dict[str, Any]:
        length = 0
        while line := self._stream.readline().strip():
            length = int(line.partition(b":")[2])
        assert length, "the debugger has gone"
        message: dict[str, Any] = json.loads(self._stream.read(length))
        if message["type"] == "event":
            self._events.append(message)
        return message


@pytest.fixture
def port() -> int:
    """Returns a free port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


@pytest.fixture
def terminals(tmp_path: Path) -> Iterator[Callable[[Terminal], Terminal]]:
    write_files(tmp_path, FILES)
    opened: list[Terminal] = []

    def keep(terminal: Terminal) -> Terminal:
        opened.append(terminal)
        return terminal

    yield keep
    for each in opened:
        each.kill()


def test_an_editor_breakpoint_leaves_no_trace_in_the_recording(
    tmp_path: Path, ports: PortBlock, port: int, terminals: Callable[[Terminal], Terminal]
) -> None:
    free = terminals(Terminal.launch(tmp_path, ports, "--record", "free.log"))
    assert free.end() == 0
    options = ("--debug", NAME, "--debugpy", str(port), "--record", "stopped.log")
    launched = terminals(Terminal.launch(tmp_path, ports, *options))
    launched.child.expect("waits for a debugger at 127.0.0.1")
    editor = Editor(port)
    editor.attach(tmp_path / "sensors.py", LOOP_LINE)
    thread = editor.stopped()
    assert editor.evaluate(thread, "self.imu.value.header.tick") == "1"
    assert launched.turns == 1
    editor.go_on(tmp_path / "sensors.py", thread)
    assert launched.end() == 0
    assert difference(tmp_path / "free.log", tmp_path / "stopped.log") == ""


def test_an_editor_attaches_to_a_running_system_and_detaches(
    tmp_path: Path, ports: PortBlock, port: int, terminals: Callable[[Terminal], Terminal], launch: Launch
) -> None:
    launched = launch("parts.yaml", "--set", f"public_url={ports.public_url}")
    run = Steered(launched, ports)
    terminal = terminals(Terminal.debug(tmp_path, ports, NAME, "--debugpy", str(port)))
    terminal.child.expect("waits for a debugger at 127.0.0.1")
    editor = Editor(port)
    editor.attach(tmp_path / "sensors.py", LOOP_LINE)
    thread = editor.stopped()
    tick = int(editor.evaluate(thread, "self.imu.value.header.tick"))
    assert run.tick == tick == terminal.turns
    assert run.component(NAME)["state"] == "held"
    editor.go_on(tmp_path / "sensors.py", thread)
    run.ticks_pass()
    terminal.child.sendintr()
    assert terminal.end() == 0
    launched.until_true(lambda: run.component(NAME)["starts"] == 3, "that it is given back")
    run.ticks_pass()
    assert "equal" in run.fwk("replay", str(run.end()), "--verify")
    assert launched.gone_within(10.0)
