"""Commands and requests from another terminal, into a real run."""

import os
import signal
from pathlib import Path
from typing import Any

import pytest

from fwk.control.address import gateway_address
from fwk.control.client import Client, RefusedError
from fwk.lcm.messages import type_named
from fwk.lcm.type_registry import use_types_of
from tests.harness import commands
from tests.harness.commands import BIN
from tests.harness.components import sources
from tests.harness.fixtures import Launch
from tests.harness.logs import Recording
from tests.harness.runs import TIMEOUT_S, PortBlock, write_files
from tests.programs.command_system import command_system
from tests.programs.control_system import Steered

pytestmark = pytest.mark.system


@pytest.fixture(scope="module", autouse=True)
def _types(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = tmp_path_factory.mktemp("types")
    write_files(folder, sources("lcmtypes/lift.lcm"))
    use_types_of(folder)


@pytest.fixture
def folder(tmp_path: Path, ports: PortBlock) -> Path:
    """A user's folder with a lifter and an adder, but without clients."""
    files = command_system(ports.public_url)
    lines = [line for line in files["launch/lift.yaml"].splitlines() if "worker" not in line and "speed" not in line]
    write_files(tmp_path, {**files, "launch/lift.yaml": "\n".join(lines) + "\n"})
    (tmp_path / "traces").mkdir()
    return tmp_path


def started(launch: Launch, ports: PortBlock, loss: str = "0") -> Steered:
    return Steered(launch("launch/lift.yaml", env={"FWK_TEST_LOSS": loss}), ports)


def begun(recording: Recording) -> list[tuple[str, int, float]]:
    return [(lifted.sender, lifted.sequence, lifted.height_m) for lifted in recording.decoded("r/lifted")]


def test_fwk_call_prints_answers_and_sets_the_exit_code(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = started(launch, ports)
    assert run.fwk("call", "r/lift", "height_m=1.5").startswith("r/lift: done, tick ")
    assert ": there is a floor" in run.fwk("call", "r/lift", "height_m=-1", code=1)
    assert "r/lift: rejected, tick " in run.fwk("call", "r/lift", "height_m=101", code=1)
    assert "r/lift: accepted, tick " in run.fwk("call", "r/lift", "height_m=2", "--accepted")
    assert "\n  sum: 12\n" in run.fwk("call", "r/sum", "n=2", "numbers=[5, 7]")
    answer = run.json("call", "r/sum", "numbers=[1, 2, 3]")
    assert (answer["state"], answer["reply"], answer["sequence"]) == ("done", {"sum": 6}, 2)
    assert "no component carries out 'r/lfit'; did you mean 'r/lift'?" in run.fwk("call", "r/lfit", code=2)
    assert "has no field 'height'; did you mean 'height_m'?" in run.fwk("call", "r/lift", "height=1", code=2)
    rows = {row["channel"]: row["writer"] for row in run.json("bb", "list")}
    assert rows["r/lift@outside"] == "fwk call"
    log = run.end()
    recording = Recording(log)
    assert begun(recording) == [("outside", 1, 1.5), ("outside", 2, -1.0), ("outside", 4, 2.0)]
    headers = recording.headers("r/lift@outside")
    assert [(header.writer, header.stage, header.sequence) for header in headers] == [
        ("outside", -1, number) for number in (1, 2, 3, 4)
    ]
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")


def test_lost_datagrams_change_nothing(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = started(launch, ports, loss="0.2")
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        for number in range(1, 31):
            assert last_state(client, "r/lift", height_m=float(number)) == "done"
    log = run.end()
    assert begun(Recording(log)) == [("outside", number, float(number)) for number in range(1, 31)]
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")


def encoded(**fields: object) -> str:
    """Returns a lift command in hexadecimal digits."""
    message: Any = type_named("lift.lift_t")()
    for name, value in fields.items():
        setattr(message, name, value)
    return str(message.encode().hex())


def last_state(client: Client, name: str, expires_s: float = 100.0, **fields: object) -> str:
    for answer in client.follow("call", TIMEOUT_S, name=name, data=encoded(**fields), expires_s=expires_s):
        if answer["state"] not in ("sent", "accepted"):
            return str(answer["state"])
    return "timed out"


def test_a_command_to_a_stopped_component_never_begins(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = started(launch, ports)
    run.fwk("stop", "r/lifter")
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        assert client.ask("call", name="r/lift", data=encoded(height_m=1.0), expires_s=1000.0)["state"] == "sent"
    run.fwk("start", "r/lifter")
    assert "r/lift: done" in run.fwk("call", "r/lift", "height_m=2")
    log = run.end()
    recording = Recording(log)
    assert begun(recording) == [("outside", 2, 2.0)]
    first = recording.decoded("r/lift@answers")[0].answer
    assert (first.sequence, first.reason) == (1, "r/lifter was started after it had been sent")
    assert "byte for byte" in run.fwk("replay", str(log), "--verify")


def test_fwk_call_refuses_a_component_that_is_stopped(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = started(launch, ports)
    run.fwk("stop", "r/lifter")
    said = run.fwk("call", "r/lift", "height_m=1", "--timeout", "1000", code=1)
    assert "error: r/lift: not sent, because r/lifter is stopped" in said
    assert "; 'fwk start r/lifter' starts it" in said
    run.fwk("start", "r/lifter")
    assert "r/lift: done" in run.fwk("call", "r/lift", "height_m=2")
    assert begun(Recording(run.end())) == [("outside", 1, 2.0)]


def restarts_late(folder: Path) -> None:
    """Lets the lifter wait for an hour before it restarts, unless it is asked to."""
    file = folder / "launch/lift.yaml"
    file.write_text(file.read_text().replace('Lifter" }', 'Lifter", restart: { backoff_s: 3600.0 } }'))


def wait_for_state(run: Steered, state: str) -> None:
    run.launched.until_true(lambda: run.component("r/lifter")["state"] == state, f"state {state}")


def said_until_restart(run: Steered, folder: Path, ports: PortBlock) -> str:
    """Returns the output of a call of the lifter that restarts once the call waits for it."""
    words = [str(BIN / "fwk"), "call", "r/lift", "height_m=1", "--timeout", "100", "--bus-port", str(ports.bus)]
    with (folder / "said").open("wb") as said:
        call = commands.start(words, folder, {**os.environ, "HOME": str(folder)}, said.fileno(), said.fileno())
        waits = "no further answer yet; the run waits for r/lifter"
        run.launched.until_true(lambda: waits in (folder / "said").read_text(), "a call that waits")
        run.steer("restart", "r/lifter")
        call.wait(TIMEOUT_S)
    return (folder / "said").read_text()


def test_fwk_call_waits_for_a_component_that_restarts(launch: Launch, folder: Path, ports: PortBlock) -> None:
    """The lifter ends between two ticks, so the next one begins with its restart: the call was sent before."""
    restarts_late(folder)
    run = started(launch, ports)
    run.fwk("pause")
    os.kill(run.launched.host("r/lifter"), signal.SIGKILL)
    wait_for_state(run, "waiting")
    run.ask("resume")
    assert "r/lifter was started after it had been sent" in said_until_restart(run, folder, ports)
    assert begun(Recording(run.end())) == []


def test_a_restart_within_a_tick_gets_the_call_in_the_next(launch: Launch, folder: Path, ports: PortBlock) -> None:
    """The lifter ends in its iteration and restarts in the same tick, before the call becomes visible."""
    restarts_late(folder)
    run = started(launch, ports)
    lifter = run.launched.host("r/lifter")
    os.kill(lifter, signal.SIGSTOP)
    run.launched.until_true(lambda: "r/lifter" in run.ask("status")["waits_for"], "a tick that waits for it")
    os.kill(lifter, signal.SIGKILL)
    wait_for_state(run, "waiting")
    assert "r/lift: done, tick " in said_until_restart(run, folder, ports)
    assert begun(Recording(run.end())) == [("outside", 1, 1.0)]


def test_an_unanswered_call_tells_that_the_run_is_paused(launch: Launch, folder: Path, ports: PortBlock) -> None:
    run = started(launch, ports)
    run.fwk("pause")
    said = run.fwk("call", "r/lift", "height_m=1", "--timeout", "0.5", code=1)
    assert "r/lifter is running, but the run is paused after tick " in said
    assert "'fwk resume' goes on" in said
    run.end()


def test_a_command_fails_when_its_component_is_stopped(launch: Launch, folder: Path, ports: PortBlock) -> None:
    file = folder / "launch/lift.yaml"
    file.write_text(file.read_text().replace('Lifter" }', 'Lifter", config: { ticks: 1000000 } }'))
    run = started(launch, ports)
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        answers = client.follow("call", TIMEOUT_S, name="r/lift", data=encoded(height_m=1.0), expires_s=100.0)
        assert [next(answers)["state"] for _ in range(2)] == ["sent", "accepted"]
        run.steer("stop", "r/lifter")
        last = next(answers)
    assert (last["state"], last["reason"]) == ("failed", "r/lifter was stopped")
    run.steer("start", "r/lifter")
    run.ticks_pass()
    assert "byte for byte" in run.fwk("replay", str(run.end()), "--verify")


def test_a_command_fails_when_its_component_dies(launch: Launch, folder: Path, ports: PortBlock) -> None:
    file = folder / "launch/lift.yaml"
    file.write_text(file.read_text().replace('Lifter" }', 'Lifter", config: { ticks: 1000000 } }'))
    run = started(launch, ports)
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        answers = client.follow("call", TIMEOUT_S, name="r/lift", data=encoded(height_m=1.0), expires_s=100.0)
        assert [next(answers)["state"] for _ in range(2)] == ["sent", "accepted"]
        os.kill(run.launched.host("r/lifter"), signal.SIGKILL)
        last = next(answers)
    assert (last["state"], last["reason"]) == ("failed", "r/lifter was started after it had been sent")
    assert len(begun(Recording(run.end()))) == 1


def test_a_flood_of_calls_and_malformed_calls_are_refused(launch: Launch, folder: Path, ports: PortBlock) -> None:
    file = folder / "launch/lift.yaml"
    file.write_text(file.read_text().replace('Lifter" }', 'Lifter", config: { ticks: 1000000 } }'))
    run = started(launch, ports)
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        for _ in range(64):
            run.ticks_pass(0)
            assert next(client.follow("call", TIMEOUT_S, name="r/lift", data=encoded(), expires_s=1000.0))["ok"]
        for data, reason in (
            (encoded(), "queue full: 64 commands to r/lift are not finished"),
            ("00", "queue full"),
        ):
            with pytest.raises(RefusedError, match=reason):
                for _ in client.follow("call", TIMEOUT_S, name="r/lift", data=data, expires_s=1000.0):
                    pass  # answers to the others
    with Client(gateway_address(ports.bus), TIMEOUT_S) as client:
        for data, reason in (("00", "r/lift: not a lift.lift_t"), ("xyz", "hexadecimal"), ("00", "r/lift: not a")):
            with pytest.raises(RefusedError, match=reason):
                client.ask("call", name="r/lift", data=data, expires_s=1000.0)
        with pytest.raises(RefusedError, match="expires_s"):
            client.ask("call", name="r/lift", data=encoded(), expires_s=-1.0)
    run.ticks_pass(3)
    assert len(Recording(run.end()).headers("r/lift@outside")) == 64
