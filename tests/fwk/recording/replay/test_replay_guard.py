"""A replay reaches nothing outside: no device, no program, no connection, no file that is written."""

import ctypes
import io
import os
import pdb
import shutil
import socket
import sqlite3
import struct
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import lcm
import pytest
from typer.testing import CliRunner

from fwk import Component, Writes
from fwk.cli.commands import app
from fwk.model.tick_events import FinalDone, HostStarted, HostStopped, StageBegun, StageDone
from fwk.recording.replay.guard import Guard, ReachesOutsideError
from fwk.testing.plans import plan_of
from lcmtypes.soccer import pose_t
from tests.fwk.recording.replay.replay_logs import HandMadeLog

THINK = 5
DEVICE = "/dev/ptmx"
TERMINAL = os.ttyname(os.openpty()[1])
opened: list[int] = []


class Wheels(Component):
    """Drives a device and survives its absence; its class does not declare that."""

    stage = "think"
    pose: Writes[pose_t]

    def loop(self) -> None:
        try:
            opened.append(os.open(DEVICE, os.O_RDWR | os.O_NOCTTY))
        except OSError:
            return
        self.pose.write()


class DeclaredWheels(Wheels):
    reaches_outside = True


class HarmlessWheels(Wheels):
    reaches_outside = False


class Notes(Component):
    """Keeps notes in a file; its class does not declare that."""

    stage = "think"
    pose: Writes[pose_t]

    def init(self) -> None:
        self.pose.write()

    def finalize(self) -> None:
        Path("notes.csv").write_text("those of the replay")


@pytest.fixture(autouse=True)
def _device() -> None:
    opened.clear()


def recorded(path: Path, component: type[Component]) -> HandMadeLog:
    log = HandMadeLog(path, plan_of({"r/wheels": component}))
    log.message("r/pose", pose_t(), "r/wheels", 1, THINK)
    log.tick(1, [HostStarted(0, 1, 0), StageBegun(THINK, THINK), StageDone(0, 1, THINK)])
    return log


def test_component_that_opens_a_device_is_left_out(tmp_path: Path) -> None:
    replay = recorded(tmp_path / "log.lcm", Wheels).replayed()
    assert opened == []
    assert list(replay.left_out) == ["r/wheels"]
    assert replay.left_out["r/wheels"] == (
        f"it opens {DEVICE}, which reaches outside; 'reaches_outside = False' in Wheels lets replays do that"
    )
    assert (replay.compared, replay.iterations) == (0, 0)


def test_declared_driver_is_left_out_from_the_start(tmp_path: Path) -> None:
    replay = recorded(tmp_path / "log.lcm", DeclaredWheels).replayed()
    assert opened == []
    assert replay.left_out == {"r/wheels": "it reaches outside"}


def test_replay_command_says_that_it_compared_nothing(tmp_path: Path) -> None:
    recorded(tmp_path / "log.lcm", DeclaredWheels).replayed()
    done = CliRunner().invoke(app, ["replay", str(tmp_path / "log.lcm"), "--verify"])
    assert done.stdout.splitlines() == [
        "0 iterations replayed",
        "not replayed: r/wheels: it reaches outside",
        "nothing was compared: none of these components wrote a message",
    ]
    assert done.exit_code == 0


def test_component_leaves_the_files_of_the_run_alone(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("notes.csv").write_text("those of the run")
    log = recorded(tmp_path / "log.lcm", Notes)
    log.tick(2, [HostStopped(0), FinalDone(0, 1)])
    replay = log.replayed()
    assert Path("notes.csv").read_text() == "those of the run"
    assert (replay.compared, replay.differences) == (1, [])
    said = "it writes notes.csv, which reaches outside; 'reaches_outside = False' in Notes lets replays do that"
    assert replay.left_out == {"r/wheels": said}


def test_component_that_declares_no_harm_is_replayed(tmp_path: Path) -> None:
    replay = recorded(tmp_path / "log.lcm", HarmlessWheels).replayed()
    assert len(opened) == 1
    os.close(opened[0])
    assert replay.left_out == {}
    assert (replay.compared, replay.iterations) == (1, 1)


def _connect() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.connect(("127.0.0.1", 9))


def _open_in_c() -> None:
    """Opens a terminal, which is a device, as a library in C does: Python hears nothing of that."""
    opened.append(ctypes.CDLL(None).open(TERMINAL.encode(), os.O_RDWR | os.O_NOCTTY))


def _bind_in_c() -> None:
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    opened.append(made.detach())
    address = struct.pack("=HH4s8x", socket.AF_INET, 0, socket.inet_aton("127.0.0.1"))
    assert ctypes.CDLL(None).bind(opened[-1], address, len(address)) == 0


@pytest.mark.parametrize(
    ("attempt", "reason"),
    [
        (lambda: Path(DEVICE).read_bytes(), DEVICE),
        (lambda: subprocess.run(["true"], check=True), "program"),
        (lambda: os.system("true"), "program"),
        (_connect, "network"),
        (lambda: os.spawnlp(os.P_WAIT, "true", "true"), "program"),
        (lambda: os.kill(os.getpid(), 0), "signal"),
        (lambda: Path("/proc/self/comm").write_text("wheels"), "/proc/self/comm"),
        (_open_in_c, TERMINAL),
        (_bind_in_c, "connection at 127.0.0.1"),
    ],
    ids=["device", "subprocess", "system", "network", "spawn", "signal", "setting", "library", "socket"],
)
def test_guard_refuses_access_to_the_outside(attempt: Callable[[], object], reason: str) -> None:
    guard = Guard()
    with pytest.raises(ReachesOutsideError, match=reason), guard.watching("r/wheels"):
        attempt()


@pytest.mark.parametrize(
    ("attempt", "reason"),
    [
        (lambda: lcm.LCM("udpm://239.255.76.67:7667?ttl=0").publish("WHEELS", b"1"), "network"),
        (lambda: opened.append(socket.socket(socket.AF_INET, socket.SOCK_DGRAM).detach()), "socket of the network"),
    ],
    ids=["lcm", "kept_socket"],
)
def test_guard_refuses_sockets_that_c_will_use(attempt: Callable[[], object], reason: str) -> None:
    guard = Guard()
    with pytest.raises(ReachesOutsideError, match=reason), guard.watching("r/wheels"):
        attempt()
    for descriptor in opened:
        os.close(descriptor)


def _open_to_write_in_c() -> None:
    opened.append(ctypes.CDLL(None).open(b"kept", os.O_RDWR))


CHANGES = "append os write remove rename replace folder link truncate mode database copy tree library"


@pytest.mark.parametrize(
    ("attempt", "reason"),
    [
        (lambda: Path("board").open("a").close(), "writes board"),
        (lambda: os.open("kept", os.O_RDWR), "writes kept"),
        (lambda: Path("kept").write_text("1"), "writes kept"),
        (lambda: Path("kept").unlink(), "removes kept"),
        (lambda: Path("kept").rename("board"), "renames kept"),
        (lambda: os.replace(tempfile.mkstemp()[1], "kept"), "renames kept"),
        (lambda: Path("board").mkdir(), "makes board"),
        (lambda: Path("board").symlink_to("kept"), "makes board"),
        (lambda: os.truncate("kept", 0), "writes kept"),
        (lambda: Path("kept").chmod(0), "changes kept"),
        (lambda: sqlite3.connect("board"), "writes board"),
        (lambda: shutil.copy("kept", "board"), "writes board"),
        (lambda: shutil.rmtree("."), "removes .*/kept"),
        (_open_to_write_in_c, "opens .*/kept to write"),
    ],
    ids=CHANGES.split(),
)
def test_guard_refuses_changes_of_ordinary_files(
    attempt: Callable[[], object], reason: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("kept").write_text("untouched")
    guard = Guard()
    with pytest.raises(ReachesOutsideError, match=reason), guard.watching("r/wheels"):
        attempt()
    for descriptor in opened:
        os.close(descriptor)
    assert [(file.name, file.read_text()) for file in tmp_path.iterdir()] == [("kept", "untouched")]


def test_guard_lets_private_files_be_written(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    (tmp_path / "notes").write_text("a")
    with Guard().watching("r/wheels"):
        assert (tmp_path / "notes").read_text() == "a"
        with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryFile() as file:
            file.write(b"a")
            (Path(folder) / "more").mkdir()
            (Path(folder) / "notes").write_text("a")
            (Path(folder) / "notes").rename(Path(folder) / "more" / "notes")
        for library in (tmp_path / "cache" / "fonts", tmp_path / "__pycache__"):
            library.mkdir(parents=True)
            (library / "made").write_text("a")
        tmp_path.mkdir(exist_ok=True)
        sqlite3.connect(":memory:").close()
        Path("/dev/null").write_text("a")
        with suppress(FileNotFoundError):
            (tmp_path / "missing").read_bytes()


def test_guard_lets_users_do_what_they_type_in_a_debugger() -> None:
    typed = (
        f"import os; os.close(os.open({DEVICE!r}, os.O_RDWR | os.O_NOCTTY))\nimport os; os.kill(os.getpid(), 0)\nc\n"
    )
    said = io.StringIO()
    with Guard().watching("r/wheels"):
        pdb.Pdb(stdin=io.StringIO(typed), stdout=said, nosigint=True, readrc=False).runcall(lambda: None)
    assert "***" not in said.getvalue()


@pytest.mark.filterwarnings("ignore::pytest.PytestUnhandledThreadExceptionWarning")
def test_thread_of_a_component_reaches_nothing_later() -> None:
    guard, go = Guard(), threading.Event()
    done: list[int] = []

    def open_later() -> None:
        go.wait()
        done.append(os.open(DEVICE, os.O_RDWR | os.O_NOCTTY))

    thread = threading.Thread(target=open_later)
    with guard.watching("r/wheels"):
        thread.start()
    go.set()
    thread.join()
    assert done == []
    assert guard.refused == {"r/wheels": f"it opens {DEVICE}"}
    with pytest.raises(ReachesOutsideError, match=DEVICE), guard.watching("r/wheels"):
        pass


def test_threads_of_the_replay_itself_are_not_watched() -> None:
    guard, done = Guard(), []
    with guard.watching("r/eyes"):
        pass
    thread = threading.Thread(target=lambda: done.append(Path("/dev/null").stat()))
    thread.start()
    thread.join()
    assert (len(done), guard.refused) == (1, {})


def test_module_that_opens_a_device_is_not_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "code"
    folder.mkdir()
    monkeypatch.setenv("IMPORTED", "")
    source = f"import os\nos.environ['IMPORTED'] = 'yes'\nos.open({DEVICE!r}, os.O_RDWR | os.O_NOCTTY)\n"
    (folder / "opening_wheels.py").write_text(source)
    monkeypatch.syspath_prepend(str(folder))
    plan = plan_of({"r/wheels": Wheels})
    component = replace(plan.components[0], module="opening_wheels")
    replay = HandMadeLog(tmp_path / "log.lcm", replace(plan, components=(component,))).replayed()
    assert os.environ["IMPORTED"] == "yes"
    assert replay.left_out == {
        "r/wheels": f"opening_wheels cannot be imported in a replay: it opens {DEVICE}; "
        "with 'reaches_outside = False' its init() may do so"
    }


def test_replay_ends_if_a_component_never_stops_trying(capfd: pytest.CaptureFixture[str]) -> None:
    child = os.fork()
    if child == 0:
        with Guard().watching("r/stubborn"):
            while True:
                with suppress(BaseException):
                    os.open(DEVICE, os.O_RDWR | os.O_NOCTTY)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 2
    assert capfd.readouterr().err == (
        f"error: r/stubborn: it opens {DEVICE}, which reaches outside, and tries again whenever the replay refuses "
        "that; declare 'reaches_outside' in its class, or replay other components with --only\n"
    )


def test_replays_of_a_process_share_one_audit_hook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    added: list[object] = []
    recorded(tmp_path / "first.lcm", Wheels).replayed()
    monkeypatch.setattr(sys, "addaudithook", added.append)
    second = recorded(tmp_path / "second.lcm", Wheels).replayed()
    assert list(second.left_out) == ["r/wheels"]
    assert added == []
