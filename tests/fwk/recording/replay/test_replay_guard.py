"""A replay reaches nothing outside: no device, no program, no connection."""

import os
import socket
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from fwk import Component, Writes
from fwk.model.tick_events import HostStarted, StageBegun, StageDone
from fwk.recording.replay.guard import Guard, ReachesOutsideError
from fwk.testing.plans import plan_of
from lcmtypes.soccer import pose_t
from tests.fwk.recording.replay.replay_logs import HandMadeLog

THINK = 5
DEVICE = "/dev/ptmx"
opened: list[int] = []


class Wheels(Component):
    """Drives a device, and survives that it is not there; its class does not say so."""

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
    assert replay.left_out["r/wheels"].startswith(f"it opens {DEVICE}")
    assert (replay.compared, replay.iterations) == (0, 0)


def test_declared_driver_is_left_out_from_the_start(tmp_path: Path) -> None:
    replay = recorded(tmp_path / "log.lcm", DeclaredWheels).replayed()
    assert opened == []
    assert replay.left_out == {"r/wheels": "it reaches outside"}


def test_component_that_declares_no_harm_is_replayed(tmp_path: Path) -> None:
    replay = recorded(tmp_path / "log.lcm", HarmlessWheels).replayed()
    assert len(opened) == 1
    os.close(opened[0])
    assert replay.left_out == {}
    assert (replay.compared, replay.iterations) == (1, 1)


def _connect() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as made:
        made.connect(("127.0.0.1", 9))


@pytest.mark.parametrize(
    ("attempt", "reason"),
    [
        (lambda: Path(DEVICE).read_bytes(), DEVICE),
        (lambda: subprocess.run(["true"], check=True), "program"),
        (lambda: os.system("true"), "program"),
        (_connect, "network"),
    ],
    ids=["device", "subprocess", "system", "network"],
)
def test_guard_refuses_what_reaches_outside(attempt: Callable[[], object], reason: str) -> None:
    guard = Guard()
    with pytest.raises(ReachesOutsideError, match=reason), guard.watching():
        attempt()


def test_guard_lets_files_be_read_and_written(tmp_path: Path) -> None:
    guard = Guard()
    with guard.watching():
        (tmp_path / "notes").write_text("a")
        assert (tmp_path / "notes").read_text() == "a"
    with pytest.raises(FileNotFoundError):
        (tmp_path / "missing").read_bytes()
