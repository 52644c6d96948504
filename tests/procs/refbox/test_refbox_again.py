"""Connections of a RefBox that go on after nonsense, and those that are made again."""

import contextlib
import socket

from fwk.testing import Bench
from lcmtypes.soccer import game_state_t
from procs.refbox.client import RefBoxClient
from procs.refbox.protocol import LONGEST
from procs.refbox.server import RefBoxServer
from tests.procs.refbox.base_station import BaseStation, say


def test_client_obeys_a_command_behind_too_long_a_message() -> None:
    with socket.create_server(("127.0.0.1", 0)) as refbox:
        refbox.settimeout(5.0)
        bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1])
        bench.iterate()
        connection, _ = refbox.accept()
        with connection:
            connection.sendall(b"x" * (LONGEST + 1) + b"\0" + say("STOP"))
            for _ in range(1000):
                bench.iterate()
                if bench.port("referee_command").sent:
                    break
    bench.finalize()
    assert [each.name for each in bench.port("referee_command").sent] == ["stop"]
    assert [line.text for line in bench.logged[1:]] == [f"RefBox: more than {LONGEST} bytes without a NUL; dropped"]


def test_command_that_is_not_obeyed_is_named() -> None:
    with socket.create_server(("127.0.0.1", 0)) as refbox:
        refbox.settimeout(5.0)
        bench = Bench(RefBoxClient, "world/refbox", port=refbox.getsockname()[1])
        bench.iterate()
        connection, _ = refbox.accept()
        with connection:
            connection.sendall(say("CORNER", "224.16.32.2"))
            for _ in range(1000):
                bench.iterate()
                if bench.port("referee_command").sent:
                    break
            bench.iterate(30)
    bench.finalize()
    refused = "the referee does not obey CORNER magenta: world/referee_command: was not answered in time"
    assert bench.logged[1].text == refused


def test_station_that_comes_back_counts_no_goal_twice() -> None:
    server = Bench(RefBoxServer, "world/refbox", port=0)
    heard: list[str] = []
    for _ in range(2):
        with contextlib.closing(BaseStation(server.component.port)) as station:
            server.port("game_state").put(state=game_state_t.DROP_BALL, half=1, stopped=True, score_cyan=1)
            server.iterate(2)
            heard += [each["command"] for each in station.heard(5)]
    server.finalize()
    assert heard == ["WELCOME", "RESET", "FIRST_HALF", "GOAL", "DROP_BALL"] * 2
