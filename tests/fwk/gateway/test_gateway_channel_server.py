"""The gateway's channel server and its log for programs, without a run."""

import json
import os
import re
import socket
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from fwk import Component, Reads, Writes
from fwk.control.address import gateway_address
from fwk.control.server import listen
from fwk.gateway.channel_server import ChannelServer, plain
from fwk.lcm import messages
from fwk.logs.json_lines import JsonLog
from fwk.logs.reader import Filter, from_plain, read_lines
from fwk.logs.rotating import RotatingFile
from fwk.model.channel_table import ChannelTable
from fwk.testing.plans import plan_of
from lcmtypes.core import log_t
from lcmtypes.robot import imu_t
from lcmtypes.soccer import pose_t


class Turner(Component):
    stage = "think"
    imu: Writes[imu_t]


class Reader(Component):
    stage = "act"
    imu: Reads[imu_t]
    pose: Writes[pose_t]


PORT = 100_000 + os.getpid()  # names a socket that does not exist


@pytest.fixture
def board() -> Iterator[ChannelServer]:
    plan = plan_of({"a/turner": Turner, "a/reader": Reader}, bus_port=PORT)
    listener = listen(gateway_address(plan.bus_port))
    made = ChannelServer(plan, ChannelTable(plan), lambda request, connection: None, listener)
    yield made
    made.close()


@pytest.fixture
def connection(board: ChannelServer) -> Iterator[socket.socket]:
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as made:
        made.connect(gateway_address(PORT))
        made.settimeout(5)
        yield made


def imu(heading_rad: float, sequence: int) -> bytes:
    made = imu_t()
    made.heading_rad = heading_rad
    made.header.sequence, made.header.tick, made.header.writer = sequence, sequence, "a/turner"
    return messages.encode(made, "a/imu")


def ask(board: ChannelServer, connection: socket.socket, **request: Any) -> dict[str, Any]:
    connection.sendall(json.dumps(request).encode() + b"\n")
    for _ in range(4):
        board.handle()
    return heard(connection)[0]


def heard(connection: socket.socket) -> list[dict[str, Any]]:
    return [json.loads(line) for line in connection.recv(1 << 20).splitlines()]


def test_channels_are_listed_with_their_newest_messages(board: ChannelServer, connection: socket.socket) -> None:
    board.message("a/imu", imu(1.5, 7), 0)
    first, second = ask(board, connection, verb="channels")["channels"]
    assert (first["channel"], first["type"], first["writer"], first["readers"]) == (
        "a/imu",
        "robot.imu_t",
        "a/turner",
        ["a/reader"],
    )
    assert (first["messages"], first["sequence"], first["tick"]) == (1, 7, 7)
    assert (second["channel"], second["messages"], second["age_s"]) == ("a/pose", 0, None)


def test_the_newest_message_is_shown_by_fields(board: ChannelServer, connection: socket.socket) -> None:
    assert ask(board, connection, verb="show", channel="a/imu")["value"] is None
    board.message("a/imu", imu(1.5, 1), 0)
    board.message("a/imu", imu(2.5, 2), 0)
    answer = ask(board, connection, verb="show", channel="a/imu")
    assert (answer["value"]["heading_rad"], answer["sequence"]) == (2.5, 2)


def test_a_watcher_gets_each_new_message_of_that_channel(board: ChannelServer, connection: socket.socket) -> None:
    ask(board, connection, verb="watch", channel="a/imu")
    for sequence in (1, 2):
        board.message("a/imu", imu(0.5 * sequence, sequence), 0)
        board.message("fwk/log", b"", 0)
    assert [each["value"]["heading_rad"] for each in heard(connection)] == [0.5, 1.0]


def test_only_messages_that_are_newer_are_given(board: ChannelServer, connection: socket.socket) -> None:
    assert ask(board, connection, verb="newest", known={"a/imu": 0, "a/pose": 0})["messages"] == {}
    for sequence in (4, 5):
        board.message("a/imu", imu(0.5, sequence), 0)
    newest = {"a/imu": imu(0.5, 5).hex()}
    assert ask(board, connection, verb="newest", known={"a/imu": 4, "a/pose": 0, "no/such": 0})["messages"] == newest
    assert ask(board, connection, verb="newest", known={"a/imu": 5})["messages"] == {}
    assert ask(board, connection, verb="newest", known={"a/imu": "x"})["error"].startswith("not a request: ")


def test_an_unknown_channel_is_refused_with_the_nearest(board: ChannelServer, connection: socket.socket) -> None:
    answer = ask(board, connection, verb="show", channel="a/imi")
    assert answer == {"ok": False, "error": "no channel 'a/imi'; did you mean 'a/imu'?"}


def test_bytes_that_do_not_decode_are_shown_too(board: ChannelServer, connection: socket.socket) -> None:
    board.message("a/imu", imu(1.0, 1)[:-3], 0)
    assert "do not decode" in ask(board, connection, verb="watch", channel="a/imu")["error"]
    board.message("a/imu", imu(1.0, 2), 0)
    ask(board, connection, verb="watch", channel="a/imu")
    board.message("a/imu", imu(1.0, 3)[:-3], 0)
    board.message("a/imu", imu(2.0, 4), 0)
    assert [each["sequence"] for each in heard(connection)] == [4]


def test_long_bytes_are_only_counted() -> None:
    assert plain([b"\x01\x02", bytes(1000)]) == [[1, 2], "1000 bytes"]


def line(**fields: Any) -> log_t:
    made = log_t()
    made.component, made.level, made.file, made.text = "a/turner", log_t.INFO, "procs/turner.py", "Turned"
    for name, value in fields.items():
        setattr(made, name, value)
    return made


def test_the_log_for_programs_keeps_every_field(tmp_path: Path) -> None:
    written = line(tick=3, time_us=150_000, wall_us=5_000_000, line=12, text='two\nlines, "quoted" é')
    log = JsonLog(RotatingFile(tmp_path / "log", 1000, 1, pytest.fail))
    log.message("fwk/log", written.encode(), 0)
    log.message("a/imu", b"", 0)
    log.close()
    with open(tmp_path / "log", "a") as file:
        file.write('{"level": "in')  # the run was killed in the middle of a line
    (read,) = read_lines(tmp_path / "log")
    assert messages.to_dict(from_plain(read)) == messages.to_dict(written)


def test_messages_written_later_are_read_too(tmp_path: Path) -> None:
    log = JsonLog(RotatingFile(tmp_path / "log", 1000, 1, pytest.fail))
    log.message("fwk/log", line(tick=1).encode(), 0)
    looks = iter((True, True, False))
    lines = read_lines(tmp_path / "log", lambda: next(looks))
    assert next(lines)["tick"] == 1
    log.message("fwk/log", line(tick=2).encode(), 0)
    assert [each["tick"] for each in lines] == [2]
    log.close()


@pytest.mark.parametrize(
    ("conditions", "wanted"),
    [
        ({}, True),
        ({"level": "info"}, True),
        ({"level": "warning"}, False),
        ({"component": "a"}, True),
        ({"component": "*/turner"}, True),
        ({"component": "b"}, False),
        ({"tick": (3, 3)}, True),
        ({"tick": (4, 9)}, False),
        ({"file": "turner.py", "line": 12}, True),
        ({"line": 13}, False),
        ({"file": "procs/turner.py"}, True),
        ({"file": "a/procs/turner.py"}, False),
        ({"file": "ner.py"}, False),
        ({"text": re.compile("T.*d$")}, True),
        ({"text": re.compile("burn")}, False),
        ({"time_us": (0, 150_000)}, True),
        ({"time_us": (150_001, 200_000)}, False),
        ({"since_us": 5_000_000}, True),
        ({"since_us": 5_000_001}, False),
        ({"until_us": 5_000_000}, True),
        ({"until_us": 4_999_999}, False),
    ],
)
def test_all_conditions_have_to_hold(conditions: dict[str, Any], wanted: bool) -> None:
    fields = {**messages.to_dict(line(tick=3, time_us=150_000, wall_us=5_000_000, line=12)), "level": "info"}
    assert Filter(**conditions).wants(fields) is wanted
