"""Lines reach the system's log, and a run continues without one."""

import re
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from fwk.component.log import LEVELS
from fwk.logs import targets
from fwk.logs.syslog import Syslog
from fwk.model.sections import LogPlan
from lcmtypes.core import log_t


def line(level: str = "info", text: str = "text") -> bytes:
    made = log_t()
    made.level, made.component, made.tick, made.text = LEVELS[level], "a/b", 7, text
    made.file, made.line, made.wall_us = "procs/b.py", 3, 1_000_000
    return made.encode()


@pytest.fixture
def daemon(tmp_path: Path) -> Iterator[socket.socket]:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as made:
        made.bind(str(tmp_path / "log"))
        made.settimeout(10.0)
        yield made


def test_the_daemon_gets_level_component_tick_and_place(daemon: socket.socket) -> None:
    (sink,) = targets.syslog(LogPlan(syslog="warning", syslog_to=daemon.getsockname()), "soccer", pytest.fail)
    for level in LEVELS:
        sink.message("fwk/log", line(level, f"of {level}"), 0)
    sink.message("a/imu", b"", 0)
    sink.close()
    first, second = daemon.recv(9000).decode(), daemon.recv(9000).decode()
    assert re.fullmatch(
        r"<12>\w{3} [ \d]\d \d\d:\d\d:\d\d fwk\[\d+\]: soccer a/b tick 7: of warning \(procs/b\.py:3\)", first
    )
    assert second.startswith("<11>")


def test_another_machine_gets_the_senders_name() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as remote:
        remote.bind(("127.0.0.1", 0))
        remote.settimeout(10.0)
        sink = Syslog(f"127.0.0.1:{remote.getsockname()[1]}", "soccer", pytest.fail)
        sink.message("fwk/log", line(), 0)
        sink.close()
        assert f" {socket.gethostname()} fwk[" in remote.recv(9000).decode()


def test_without_the_option_syslog_is_not_used() -> None:
    assert targets.syslog(LogPlan(), "soccer", pytest.fail) == []


def test_a_missing_daemon_is_reported_once_and_counted(tmp_path: Path) -> None:
    said: list[str] = []
    sink = Syslog(f"{tmp_path}/none", "soccer", said.append)
    for _ in range(3):
        sink.message("fwk/log", line(), 0)
    sink.close()
    assert said == [
        f"no syslog at {tmp_path}/none: No such file or directory; its lines are in the other targets",
        f"3 lines are missing in syslog at {tmp_path}/none",
    ]


def test_a_restarted_daemon_is_found(tmp_path: Path) -> None:
    sink, heard = Syslog(f"{tmp_path}/log", "soccer", pytest.fail), []
    for number in range(2):
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as daemon:
            daemon.bind(f"{tmp_path}/log")
            sink.message("fwk/log", line(text=f"number {number}"), 0)
            heard.append("number " in daemon.recv(9000).decode())
        Path(f"{tmp_path}/log").unlink()
    sink.close()
    assert heard == [True, True]


def test_a_silent_syslog_daemon_delays_nothing(daemon: socket.socket) -> None:
    said: list[str] = []
    sink = Syslog(daemon.getsockname(), "soccer", said.append)
    for _ in range(2000):
        sink.message("fwk/log", line(text="ö" * 8000), 0)
    sink.close()
    assert re.fullmatch(r"\d+ lines are missing in syslog at .*", said[-1])
    assert len(daemon.recv(90_000)) <= 8192
