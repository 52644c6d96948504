"""`fwk debug NAME` on a running system: the component moves into a terminal, all processes wait, and it returns."""

import os
import signal
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest

from fwk.control.client import ControlError
from tests.harness.logs import Recording
from tests.harness.runs import Launched, PortBlock, write_files
from tests.harness.terminals import FILES, LOOP_LINE, Terminal
from tests.programs.control_system import Steered, write_system

pytestmark = pytest.mark.system

NAME = "r/world_model"
Debug = Callable[..., Terminal]


@pytest.fixture
def start(tmp_path: Path, ports: PortBlock, launch: Callable[..., object]) -> Callable[..., Steered]:
    write_files(tmp_path, FILES)

    def started(*arguments: str) -> Steered:
        launched = launch("parts.yaml", "--set", f"public_url={ports.public_url}", *arguments)
        return Steered(launched, ports)  # type: ignore[arg-type]

    return started


@pytest.fixture
def debug(tmp_path: Path, ports: PortBlock) -> Iterator[Debug]:
    opened: list[Terminal] = []

    def start(*arguments: str) -> Terminal:
        opened.append(Terminal.debug(tmp_path, ports, *arguments))
        return opened[-1]

    yield start
    for each in opened:
        each.kill()


def lives(pid: int) -> bool:
    """Returns whether a process has not ended, even if its parent has not waited for it."""
    return psutil.pid_exists(pid) and psutil.Process(pid).status() != psutil.STATUS_ZOMBIE


def until_starts(run: Steered, number: int) -> None:
    """Waits until that incarnation of the component runs, started by the run itself."""

    def there() -> bool:
        component = run.component(NAME)
        return bool(component["starts"] == number and component["state"] == "running")

    run.launched.until_true(there, f"start {number} of {NAME}")


def test_a_breakpoint_in_a_running_system_shows_only_a_restart(
    start: Callable[..., Steered], debug: Debug, launch: Callable[..., Launched], tmp_path: Path
) -> None:
    run = start()
    terminal = debug(NAME)
    assert "loop()" in terminal.prompt()
    component = run.component(NAME)
    assert component["state"] == "held"
    assert terminal.child.pid in (parent.pid for parent in psutil.Process(component["pid"]).parents())
    assert run.component("r/sensor")["state"] == "running"
    terminal.ask(f"tbreak {LOOP_LINE}")
    terminal.ask("c")
    tick = int(terminal.ask("p self.imu.value.header.tick").split()[-1])
    run.launched.until_true(lambda: run.ask("status")["waits_for"] == [NAME], "that everybody waits for it")
    assert run.tick == tick == terminal.turns
    terminal.ask("p setattr(self, 'seen_in', 'pdb')")
    assert (run.tick, terminal.turns) == (tick, tick)
    terminal.type("c")
    run.ticks_pass()
    assert run.component(NAME)["state"] == "held"
    terminal.child.sendintr()
    terminal.prompt()
    terminal.type("q")
    assert terminal.end() == 0
    until_starts(run, 3)
    run.ticks_pass()
    log = run.end()
    recording = Recording(log)
    assert recording.gaps() == {}
    last = recording.records[-1].tick - 1
    assert [header.tick for header in recording.headers("r/pose")][:last] == list(range(1, last + 1))
    assert {header.writer for header in recording.headers("r/pose")} == {NAME, f"{NAME}#2", f"{NAME}#3"}
    assert "equal" in run.fwk("replay", str(log), "--verify")
    free = launch("parts.yaml", "--ticks", str(last), "--speed", "max", "--record", "free.log")
    assert free.wait() == 0, free.text
    undisturbed = Recording(tmp_path / "free.log")
    assert recording.messages["r/imu"][:last] == undisturbed.messages["r/imu"]
    for stopped, never in zip(recording.decoded("r/pose"), undisturbed.decoded("r/pose"), strict=False):
        stopped.header.writer = NAME  # the only thing that a restart changes
        assert stopped.encode() == never.encode()


@pytest.mark.parametrize("leave", ["end of input", "kill", "kill its parent", "close the terminal", "let it fail"])
def test_the_component_returns_however_the_debugger_ends(
    start: Callable[..., Steered], debug: Debug, leave: str
) -> None:
    run = start()
    terminal = debug(NAME)
    terminal.prompt()
    pid = run.component(NAME)["pid"]
    if leave == "end of input":
        terminal.child.sendeof()
        assert terminal.end() == 0
    elif leave == "kill":
        os.kill(pid, signal.SIGKILL)
        assert terminal.end() == 1
    elif leave == "kill its parent":
        os.kill(terminal.child.pid, signal.SIGKILL)
    elif leave == "close the terminal":
        terminal.child.close()
    else:
        terminal.ask("self.imu = None")
        assert "AttributeError" in terminal.ask("c")
        assert "heading_rad" in terminal.ask("l")
        terminal.type("q")
        assert terminal.end() == 0
    until_starts(run, 3)
    run.ticks_pass()
    assert not lives(pid)
    assert Recording(run.end()).gaps() == {}


def test_in_real_time_the_loop_goes_on_and_names_the_held_host(start: Callable[..., Steered], debug: Debug) -> None:
    run = start("--set", "clock=wall", "--set", "period_s=0.1")
    terminal = debug(NAME)
    terminal.prompt()
    run.ticks_pass(5)
    assert run.component(NAME)["state"] == "held"
    _, held, afterwards = run.fwk("log").partition(f"{NAME} is held by its debugger")
    assert held
    assert f"{NAME} is late" not in afterwards
    terminal.type("c")
    run.launched.until_true(lambda: run.component(NAME)["iterations"] > 3, "iterations after the breakpoint")
    terminal.child.sendintr()
    terminal.prompt()
    terminal.type("q")
    assert terminal.end() == 0
    until_starts(run, 3)
    run.ticks_pass()
    assert "equal" in run.fwk("replay", str(run.end()), "--verify")


def test_a_paused_run_can_be_debugged_step_by_step(start: Callable[..., Steered], debug: Debug) -> None:
    run = start()
    run.fwk("pause")
    tick = run.tick
    terminal = debug(NAME)
    terminal.child.expect("under pdb")
    with pytest.raises(ControlError, match="not answered within"):  # the command ends when the breakpoint has been left
        run.ask("step", timeout_s=0.5, ticks=1)
    terminal.prompt()
    assert str(tick + 1) in terminal.ask("p self.imu.value.header.tick")
    terminal.type("c")
    run.launched.until_true(lambda: run.component(NAME)["iterations"] == 1, "the iteration")
    assert run.tick == tick + 1
    run.fwk("resume")
    run.ticks_pass()
    terminal.child.sendintr()
    terminal.prompt()
    terminal.type("q")
    assert terminal.end() == 0
    until_starts(run, 3)
    assert "equal" in run.fwk("replay", str(run.end()), "--verify")


def test_attach_without_a_debugger(start: Callable[..., Steered], debug: Debug) -> None:
    run = start()
    terminal = debug(NAME, "--no-debugger")
    until_starts(run, 2)
    run.ticks_pass()
    terminal.child.sendintr()
    assert terminal.end() == 0
    until_starts(run, 3)
    run.end()


def test_components_that_cannot_be_debugged_run_on(start: Callable[..., Steered], debug: Debug, tmp_path: Path) -> None:
    run = start()
    unknown = debug("r/world_modell")
    unknown.child.expect("did you mean 'r/world_model'")
    assert unknown.end() == 2
    file = tmp_path / "sensors.py"
    file.write_text(FILES["sensors.py"].replace("class WorldModel", "class World Model"))
    broken = debug(NAME)
    broken.child.expect("sensors cannot be imported; the run keeps the old code")
    assert broken.end() == 2
    file.write_text(FILES["sensors.py"])
    first = debug(NAME)
    first.prompt()
    second = debug(NAME)
    second.child.expect(f"{NAME} is run by process")
    assert second.end() == 2
    first.type("q")
    assert first.end() == 0
    until_starts(run, 3)
    run.end()


def test_restart_and_end_of_the_run_end_the_debugger(start: Callable[..., Steered], debug: Debug) -> None:
    run = start()
    terminal = debug(NAME)
    terminal.prompt()
    run.steer("restart", NAME)
    assert terminal.end() == 1
    until_starts(run, 3)
    again = debug(NAME)
    again.prompt()
    os.kill(run.launched.process.pid, signal.SIGKILL)
    assert again.end() == 1
    assert run.launched.gone_within(15.0)


@pytest.mark.parametrize("hosting", ["process", "robot"])
def test_an_attached_vision_group_keeps_its_frames(
    tmp_path: Path, ports: PortBlock, launch: Callable[..., object], debug: Debug, hosting: str
) -> None:
    write_system(tmp_path, ports)
    run = Steered(launch("small.yaml", "--hosting", hosting), ports)  # type: ignore[arg-type]
    terminal = debug("r/finder")
    terminal.prompt()
    assert "(4, 4)" in terminal.ask("p self.image.pixels.shape")
    held = {each["name"] for each in run.ask("status")["components"] if each["state"] == "held"}
    assert held == ({"r/finder"} if hosting == "process" else {"r/counter", "r/follower", "r/camera", "r/finder"})
    terminal.type("q")
    assert terminal.end() == 0
    assert "equal" in run.fwk("replay", str(run.end()), "--verify")
