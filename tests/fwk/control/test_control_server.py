"""The control server answers or refuses every request, and never waits for a client."""

import json
import os
import socket
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as some

from fwk.control import address, server
from fwk.control.client import Client, ControlError, RefusedError
from fwk.control.requests import RequestError, SetSettings, parsed, to_gateway, to_supervisor
from fwk.control.server import Connection, Server, listen

Connect = Callable[[], socket.socket]
ADDRESS = f"\0fwk-test-control-{os.getpid()}"


def echo(line: bytes, connection: Connection) -> None:
    try:
        request = parsed(to_supervisor, line)
    except RequestError as error:
        connection.refuse(str(error))
        return
    connection.reply({"ok": True, **request.model_dump()})


@pytest.fixture
def listening() -> Iterator[Server]:
    made = Server(listen(ADDRESS), echo)
    yield made
    made.close()


@pytest.fixture
def connect(listening: Server) -> Iterator[Connect]:
    made: list[socket.socket] = []

    def start() -> socket.socket:
        made.append(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM))
        made[-1].connect(ADDRESS)
        made[-1].settimeout(0.2)
        return made[-1]

    yield start
    for each in made:
        each.close()


def answers(listening: Server, connection: socket.socket) -> list[dict[str, Any]]:
    """Lets the server work until no more answers arrive."""
    data = b""
    while True:
        for _ in range(4):
            listening.handle()
        try:
            received = connection.recv(1 << 20)
        except (TimeoutError, ConnectionError):
            break
        data += received
        if not received:
            break
    return [json.loads(line) for line in data.splitlines()]


def test_a_request_in_pieces_is_answered_once(listening: Server, connect: Connect) -> None:
    connection = connect()
    for piece in (b'{"verb"', b':"ru', b'n"}\n'):
        connection.sendall(piece)
        listening.handle()
    assert answers(listening, connection) == [{"ok": True, "verb": "run"}]


@pytest.mark.parametrize(
    ("line", "error"),
    [
        (b"hello", "not a request: Invalid JSON"),
        (b"[]", "not a request"),
        (b"{}", "verb"),
        (b'{"verb": "explode"}', "does not match any of the expected tags"),
        (b'{"verb": "steer", "action": "explode", "names": []}', "steer.action: Input should be 'start', 'stop'"),
        (b'{"verb": "steer", "action": "stop"}', "steer.names: Field required"),
        (b'{"verb": "status", "name": "x"}', "Extra inputs are not permitted"),
        (b'{"verb": "status", "names": "x"}', "Input should be a valid array"),
        (b'{"verb": "status", "names": ["' + b"x" * 300 + b'"]}', "at most 200 characters"),
        (b"\xff\xfe", "not a request"),
        (b"[" * 60_000, "not a request"),
    ],
)
def test_an_invalid_request_is_refused_and_the_next_is_answered(
    listening: Server, connect: Connect, line: bytes, error: str
) -> None:
    connection = connect()
    connection.sendall(line + b'\n{"verb":"run"}\n')
    refused, answered = answers(listening, connection)
    assert not refused["ok"]
    assert error in refused["error"]
    assert answered == {"ok": True, "verb": "run"}


def test_a_value_may_be_as_long_as_a_request() -> None:
    change = f"a/b.levels={[1.5] * 10_000}"
    asked = parsed(to_supervisor, json.dumps({"verb": "set", "changes": [change]}).encode())
    assert isinstance(asked, SetSettings)
    assert asked.changes == [change]


@given(some.lists(some.binary(max_size=200), max_size=5))
@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_no_bytes_break_a_request_reader(garbage: list[bytes]) -> None:
    for line in garbage:
        with pytest.raises(RequestError):
            parsed(to_supervisor, line)
        with pytest.raises(RequestError):
            parsed(to_gateway, line)


def test_an_endless_request_ends_the_connection(listening: Server, connect: Connect) -> None:
    connection = connect()
    connection.settimeout(None)
    sender = threading.Thread(target=lambda: _flood(connection, b"x" * (4 * server.REQUEST_MAX)))
    sender.start()
    while sender.is_alive():
        listening.handle()
    sender.join()
    connection.settimeout(0.2)
    said = "a request, with all texts in it, has at most 65,536 bytes; send shorter texts"
    assert answers(listening, connection)[-1]["error"] == said


def test_too_many_requests_at_once_end_the_connection(listening: Server, connect: Connect) -> None:
    connection = connect()
    connection.sendall(b'{"verb":"run"}\n' * (server.REQUESTS_MAX + 1))
    (answer,) = answers(listening, connection)
    assert answer["error"] == "65 requests at once; send at most 64"


def test_a_client_that_does_not_read_delays_no_other(listening: Server, connect: Connect) -> None:
    held: list[Connection] = []
    listening._answer = lambda _, connection: held.append(connection)
    silent = connect()
    silent.sendall(b"x\n")
    for _ in range(4):
        listening.handle()
    for _ in range(20):
        held[0].reply({"ballast": "x" * (1 << 20)})
    assert not held[0].open
    listening._answer = echo
    other = connect()
    other.sendall(b'{"verb":"run"}\n')
    assert answers(listening, other) == [{"ok": True, "verb": "run"}]


def test_a_stream_drops_and_counts_what_is_not_read(listening: Server, connect: Connect) -> None:
    held: list[Connection] = []
    listening._answer = lambda _, connection: held.append(connection)
    slow = connect()
    slow.sendall(b"x\n")
    for _ in range(4):
        listening.handle()
    for number in range(30):
        held[0].stream({"number": number, "ballast": "x" * 100_000})
    before = held[0].skipped
    assert before > 0
    first = answers(listening, slow)
    held[0].stream({"number": 30})
    (last,) = answers(listening, slow)
    assert last == {"number": 30, "skipped": before}
    assert len(first) + before == 30


def test_connections_in_use_are_limited(listening: Server, connect: Connect) -> None:
    listening._answer = lambda *_: None  # answered later, like a pause
    for _ in range(server.CONNECTIONS_MAX):
        connect().sendall(b"x\n")
    for _ in range(2 * server.CONNECTIONS_MAX):
        listening.handle()
    (answer,) = answers(listening, connect())
    assert "connections are open and in use already" in answer["error"]


def test_idle_connections_give_way(listening: Server, connect: Connect) -> None:
    idle = [connect() for _ in range(server.CONNECTIONS_MAX)]
    for _ in range(2 * len(idle)):
        listening.handle()
    idle[0].sendall(b'{"verb":"run"}\n')
    assert answers(listening, idle[0])[0]["ok"]
    newest = connect()
    newest.sendall(b'{"verb":"run"}\n')
    assert answers(listening, newest) == [{"ok": True, "verb": "run"}]
    assert "disconnected: idle" in answers(listening, idle[1])[0]["error"]  # the oldest that never sent a request
    idle[0].sendall(b'{"verb":"run"}\n')
    assert answers(listening, idle[0]) == [{"ok": True, "verb": "run"}]


def test_a_name_that_is_taken_is_refused_with_advice(listening: Server) -> None:
    with pytest.raises(server.ControlNameError, match="another process has the control socket @fwk-test-control"):
        listen(ADDRESS)


@pytest.mark.parametrize("brackets", ["[", "{", "[{", "[[]"])
def test_a_deeply_nested_value_is_refused_at_once(brackets: str) -> None:
    request = {"verb": "set", "changes": [f"a/b.levels={brackets * 1500}"]}
    with pytest.raises(RequestError, match=r"^not a request: [\w.]+: a value may be nested 32 deep"):
        parsed(to_supervisor, json.dumps(request).encode())


def test_another_user_is_refused(listening: Server, connect: Connect, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(server, "peer_of", lambda _: (os.getpid(), os.geteuid() + 1))
    connection = connect()
    connection.sendall(b'{"verb":"run"}\n')
    (answer,) = answers(listening, connection)
    assert answer["ok"] is False
    assert "only its own user and root are obeyed" in answer["error"]


def test_the_kernel_names_the_user_of_a_client() -> None:
    one, other = socket.socketpair(socket.AF_UNIX, socket.SOCK_STREAM)
    assert address.peer_of(one) == (os.getpid(), os.geteuid())
    one.close()
    other.close()
    assert address.obeys(0)
    assert address.obeys(os.geteuid())
    assert not address.obeys(os.geteuid() + 1)


def test_a_client_gives_up_after_its_timeout(listening: Server) -> None:
    with Client(ADDRESS, 0.05) as client, pytest.raises(ControlError, match=r"not answered within 0\.05 s"):
        client.ask("run")


def test_a_client_names_the_refused_request(listening: Server) -> None:
    done = threading.Event()

    def work() -> None:
        while not done.is_set():
            listening.handle()

    worker = threading.Thread(target=work)
    worker.start()
    try:
        with Client(ADDRESS) as client:
            assert client.ask("run") == {"ok": True, "verb": "run"}
            with pytest.raises(RefusedError, match="expected tags"):
                client.ask("explode")
    finally:
        done.set()
        worker.join()


def _flood(connection: socket.socket, data: bytes) -> None:
    try:
        connection.sendall(data)
    except OSError:
        return
