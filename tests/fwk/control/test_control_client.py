"""Requests to a run, and what programs that are not runs answer."""

import os
import re
import socket
import threading
from collections.abc import Callable, Iterator

import pytest

from fwk.control import address, client
from fwk.control.client import Client, ControlError


def test_socket_names_of_any_bytes_hide_no_run(bound: list[socket.socket]) -> None:
    port = 60000 + os.getpid() % 5000
    own = b"-%d" % os.getpid()
    others = (b"\xff\xfe", b"fwk-control-\xff\xfe", b"fwk-control-", b"fwk-control-x1")
    for name in (*(other + own for other in others), b"fwk-control-%d" % port):
        bound.append(socket.socket(socket.AF_UNIX, socket.SOCK_STREAM))
        bound[-1].bind(b"\0" + name)
    assert port in address.running()


def test_the_socket_of_another_user_is_not_asked(bound: list[socket.socket], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(address, "peer_of", lambda _: (1, os.geteuid() + 1))
    monkeypatch.setattr(address, "trusts", lambda uid: uid == os.geteuid())
    squatter = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    bound.append(squatter)
    name = f"\0fwk-control-test-{os.getpid()}"
    squatter.bind(name)
    squatter.listen()
    with pytest.raises(ControlError, match=f"belongs to user {os.geteuid() + 1}, not to you"):
        Client(name)
    accepted, _ = squatter.accept()
    assert accepted.recv(100) == b""
    accepted.close()


@pytest.mark.parametrize(
    ("sent", "error"),
    [
        (b"\xff\xfehello\n", "sends something that is not an answer"),
        (b"[]\n", "sends something that is not an answer"),
        (b"[" * 20_000 + b"\n", "sends something that is not an answer"),
        (b" " * 2000, "sends an answer without end"),
        (b"", "has not answered within 0.1 s"),
        (b'{"ok": false, "error": "\\u001b[31m"}\n', "�[31m"),
    ],
)
def test_a_program_that_is_not_a_run_gets_a_sentence(
    fake: Callable[[bytes], str], sent: bytes, error: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "_ANSWER_MAX_BYTES", 30_000 if len(sent) > 2000 else 1000)
    with Client(fake(sent), 0.1) as run, pytest.raises(ControlError, match=re.escape(error)):
        run.ask("status")


def test_an_answer_that_lacks_a_key_is_refused_where_it_is_used(fake: Callable[[bytes], str]) -> None:
    with Client(fake(b'{"ok": true, "components": [{}]}\n')) as run:
        answer = run.ask("run")
    for part in (answer, answer["components"][0]):
        with pytest.raises(ControlError, match="lacks 'state'"):
            part["state"]


def answers_late(bound: list[socket.socket], name: str, first: bytes, waits: bytes, rest: bytes) -> str:
    """Serves a request; the `rest` of its answers follows once the run was asked what it `waits` for."""
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    bound.append(listening)
    listening.bind(f"\0fwk-control-test-{os.getpid()}-{name}")
    listening.listen()

    def serve() -> None:
        slow, _ = listening.accept()
        bound.append(slow)
        slow.sendall(first)
        other, _ = listening.accept()
        bound.append(other)
        other.sendall(waits)
        slow.sendall(rest)

    threading.Thread(target=serve, daemon=True).start()
    return str(listening.getsockname().decode())


@pytest.fixture
def said(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[str]]:
    """Notices of requests that have had no answer for 50 ms."""
    monkeypatch.setattr(client, "_NOTICE_US", 50_000)
    notices: list[str] = []
    before = client.notice.set(notices.append)
    yield notices
    client.notice.reset(before)


def test_a_request_that_waits_names_what_the_run_waits_for(bound: list[socket.socket], said: list[str]) -> None:
    waits = b'{"ok": true, "waits_for": ["a/b"]}\n'
    with Client(answers_late(bound, "slow", b'{"ok": true,', waits, b' "tick": 7}\n')) as run:
        assert run.ask("pause")["tick"] == 7
    assert said == ["no answer yet; the run waits for a/b"]


def test_request_with_an_answer_lacks_a_further_one(bound: list[socket.socket], said: list[str]) -> None:
    first, last = (f'{{"ok": true, "state": "{state}"}}\n'.encode() for state in ("accepted", "done"))
    with Client(answers_late(bound, "further", first, b'{"ok": true, "waits_for": []}\n', last)) as run:
        answers = run.follow("call", 10.0, notices=True)
        assert [next(answers)["state"] for _ in range(2)] == ["accepted", "done"]
    assert said == ["no further answer of the run yet"]


def test_root_may_use_the_runs_of_all_users(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert address.trusts(1000)
    assert address.trusts(0)
    assert not address.trusts(1001)
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    assert address.trusts(1001)
