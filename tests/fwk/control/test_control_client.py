"""Choice of the run for a command: the named one, the one in FWK_RUN, or the only one."""

import contextlib
import os
import re
import socket
import threading
from collections.abc import Callable, Iterator
from itertools import count

import pytest

from fwk.clock import monotonic_us
from fwk.control import address, client
from fwk.control.client import Client, ControlError, RefusedError

_NUMBERS = count()
RUNS = {1: {"name": "match", "plan": "soccer", "pid": 11}, 2: {"name": "solo", "plan": "soccer", "pid": 22}}


@pytest.fixture
def runs(monkeypatch: pytest.MonkeyPatch) -> dict[int, dict[str, object]]:
    """The runs that exist; a test may add and remove some."""
    found: dict[int, dict[str, object]] = {port: dict(run) for port, run in RUNS.items()}
    monkeypatch.delenv(client.RUN_VARIABLE, raising=False)
    monkeypatch.setattr(address, "running", lambda: sorted(found))
    monkeypatch.setattr(client, "look", lambda: found)
    return found


@pytest.mark.parametrize(
    ("ports", "typed", "answer"),
    [
        ([], None, "nothing runs on this machine; start something with: fwk-launch FILE"),
        ([], "17700", "no run '17700' on this machine"),
        ([1], "", "a run has a name or a bus port, not ''"),
        ([1, 2], None, "several runs on this machine; choose one: --run match (soccer, pid 11) or --run solo"),
        ([1], "2", "no run '2' on this machine; there is --run match (soccer, pid 11)"),
        ([1], "mach", "no run 'mach' on this machine; there is --run match"),
    ],
)
def test_an_unclear_choice_is_refused(
    runs: dict[int, dict[str, object]], ports: list[int], typed: str | None, answer: str
) -> None:
    for port in set(runs) - set(ports):
        del runs[port]
    with pytest.raises(ControlError, match=re.escape(answer)):
        client.find_run(typed)


def test_runs_of_one_name_are_told_apart_by_port(runs: dict[int, dict[str, object]]) -> None:
    runs[2]["name"] = "match"
    with pytest.raises(RefusedError, match=r"several runs are called 'match'; .*--run 1 .* or --run 2 "):
        client.find_run("match")


@pytest.mark.parametrize(("typed", "found"), [("solo", 2), ("match", 1), ("2", 2), (2, 2)])
def test_a_run_is_found_by_name_or_port(runs: dict[int, dict[str, object]], typed: str | int, found: int) -> None:
    assert client.find_run(typed) == found


def test_the_environment_names_the_default_run(
    runs: dict[int, dict[str, object]], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FWK_RUN", "solo")
    assert client.find_run(None) == 2
    assert client.find_run("match") == 1


def test_the_only_run_needs_no_name(runs: dict[int, dict[str, object]]) -> None:
    del runs[1]
    assert client.find_run(None) == 2


def test_a_run_that_has_just_ended_does_not_answer(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(address, "running", lambda: [1])
    with pytest.raises(ControlError, match="does not answer"):
        client.supervisor("1")


@pytest.fixture
def bound() -> Iterator[list[socket.socket]]:
    made: list[socket.socket] = []
    yield made
    for each in made:
        with contextlib.suppress(OSError):  # not connected
            each.shutdown(socket.SHUT_RDWR)  # wakes the thread that accepts
        each.close()


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


@pytest.fixture
def fake(bound: list[socket.socket]) -> Callable[[bytes], str]:
    """Makes the control socket of a program that sends these bytes to every client; returns its address."""

    def make(sent: bytes) -> str:
        listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        bound.append(listening)
        listening.bind(f"\0fwk-control-test-{os.getpid()}-{next(_NUMBERS)}")  # a waiting thread keeps a closed one
        listening.listen()

        def serve() -> None:
            with contextlib.suppress(OSError):
                while True:
                    connection, _ = listening.accept()
                    bound.append(connection)
                    connection.sendall(sent)

        threading.Thread(target=serve, daemon=True).start()
        return str(listening.getsockname().decode())

    return make


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


def test_a_request_that_waits_names_what_the_run_waits_for(
    bound: list[socket.socket], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(client, "_NOTICE_US", 50_000)
    listening = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    bound.append(listening)
    listening.bind(f"\0fwk-control-test-{os.getpid()}-{next(_NUMBERS)}")
    listening.listen()

    def serve() -> None:
        slow, _ = listening.accept()
        slow.sendall(b'{"ok": true,')
        other, _ = listening.accept()
        other.sendall(b'{"ok": true, "waits_for": ["a/b"]}\n')
        slow.sendall(b' "tick": 7}\n')
        bound.extend((slow, other))

    threading.Thread(target=serve, daemon=True).start()
    said: list[str] = []
    before = client.notice.set(said.append)
    with Client(str(listening.getsockname().decode())) as run:
        assert run.ask("pause")["tick"] == 7
    client.notice.reset(before)
    assert said == ["no answer yet; the run waits for a/b"]


def test_silent_and_false_runs_hide_no_other(fake: Callable[[bytes], str], monkeypatch: pytest.MonkeyPatch) -> None:
    real = b'{"ok": true, "name": "match", "plan": "soccer", "pid": 11}\n'
    sent = [b"", b"[]\n", b"", b'{"ok": true}\n', b" ", real]
    addresses = dict(enumerate(map(fake, sent)))
    monkeypatch.setattr(address, "running", lambda: list(addresses))
    monkeypatch.setattr(address, "supervisor_address", addresses.__getitem__)
    monkeypatch.setattr(client, "_LOOK_S", 0.2)
    began_us = monotonic_us()
    assert list(client.look()) == [5]
    assert monotonic_us() - began_us < 550_000  # the silent ones are waited for together


def test_root_prefers_its_own_run(runs: dict[int, dict[str, object]]) -> None:
    runs[3] = {**runs[1], "owner": os.geteuid()}
    assert client.find_run("match") == 3
    assert client.find_run(None) == 3
    assert client.find_run("solo") == 2


def test_root_may_use_the_runs_of_all_users(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "geteuid", lambda: 1000)
    assert address.trusts(1000)
    assert address.trusts(0)
    assert not address.trusts(1001)
    monkeypatch.setattr(os, "geteuid", lambda: 0)
    assert address.trusts(1001)
