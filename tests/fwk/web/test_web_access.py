"""The gate of the console: hosts, origins, users, tokens, roles."""

import asyncio
import os
import socket
from typing import Any

import pytest

from fwk.web.access import Access, Gate, Role, is_loopback, new_tokens
from fwk.web.peer import user_of

LOCAL = Access("127.0.0.1", 8460)
REMOTE = Access("192.168.1.5", 8460, names=("robot",), tokens={"steering": Role.STEER, "reading": Role.READ})


def ask(
    access: Access, host: str, kind: str = "http", uid: int | None = os.geteuid(), query: str = "", **headers: str
) -> Any:
    """Returns role (admitted), or the messages that were sent instead."""
    admitted: list[Role] = []
    sent: list[Any] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        admitted.append(scope["state"]["role"])
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def receive() -> Any:
        raise AssertionError

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": kind,
        "path": "/board",
        "query_string": query.encode(),
        "headers": [
            (name.replace("_", "-").encode(), value.encode()) for name, value in {"host": host, **headers}.items()
        ],
        "client": ("127.0.0.1", 5000),
        "server": ("127.0.0.1", 8460),
    }
    asyncio.run(Gate(app, access, lambda own, other: uid)(scope, receive, send))
    return (admitted[0], sent) if admitted else (None, sent)


@pytest.mark.parametrize("host", ["127.0.0.1:8460", "localhost:8460", "LOCALHOST:8460", "[::1]:8460"])
def test_the_own_user_may_steer_on_loopback(host: str) -> None:
    role, sent = ask(LOCAL, host, origin=f"http://{host}")
    assert role is Role.STEER
    assert (b"x-frame-options", b"DENY") in sent[0]["headers"]
    assert any(
        name == b"content-security-policy" and b"connect-src 'self'" in value for name, value in sent[0]["headers"]
    )


@pytest.mark.parametrize("uid", [os.geteuid() + 1, None])
def test_other_users_of_the_machine_are_refused(uid: int | None) -> None:
    role, sent = ask(LOCAL, "127.0.0.1:8460", uid=uid)
    assert role is None
    assert sent[0]["status"] == 403
    assert b"only the user who started this console" in sent[1]["body"]


@pytest.mark.parametrize("host", ["evil.example:8460", "127.0.0.1", "127.0.0.1:80", ""])
def test_a_rebound_name_is_refused(host: str) -> None:
    role, sent = ask(LOCAL, host)
    assert role is None
    assert b"it answers to 127.0.0.1:8460" in sent[1]["body"]


@pytest.mark.parametrize("kind", ["http", "websocket"])
@pytest.mark.parametrize("origin", ["http://evil.example", "https://127.0.0.1:8460", "http://127.0.0.1:9999", "null"])
def test_pages_of_other_origins_are_refused(kind: str, origin: str) -> None:
    role, sent = ask(LOCAL, "127.0.0.1:8460", kind, origin=origin)
    assert role is None
    assert sent[0].get("status") == 403 or sent[0]["code"] == 4403


def test_images_in_pages_of_other_sites_are_refused() -> None:
    assert ask(LOCAL, "127.0.0.1:8460", sec_fetch_site="cross-site", sec_fetch_mode="no-cors")[0] is None
    assert ask(LOCAL, "127.0.0.1:8460", sec_fetch_site="cross-site", sec_fetch_mode="navigate")[0] is Role.STEER


def test_a_read_only_console_has_readers_only() -> None:
    assert ask(Access("127.0.0.1", 8460, read_only=True), "127.0.0.1:8460")[0] is Role.READ
    remote = Access("192.168.1.5", 8460, read_only=True, tokens={"steering": Role.STEER})
    assert ask(remote, "192.168.1.5:8460", cookie="fwk-web-8460=steering")[0] is Role.READ


def test_other_machines_need_the_token_of_their_role() -> None:
    assert ask(REMOTE, "robot:8460", cookie="fwk-web-8460=steering")[0] is Role.STEER
    assert ask(REMOTE, "robot:8460", cookie="other=1; fwk-web-8460=reading")[0] is Role.READ
    for cookie in ("fwk-web-8460=guess", "fwk-web-8461=steering", "", "\x00"):
        role, sent = ask(REMOTE, "robot:8460", cookie=cookie)
        assert role is None
        assert b"open the link with the token" in sent[1]["body"]


def test_a_token_moves_from_the_link_into_a_cookie() -> None:
    role, sent = ask(REMOTE, "robot:8460", query="run=red&token=reading")
    headers = dict(sent[0]["headers"])
    assert (role, sent[0]["status"]) == (None, 303)
    assert headers[b"location"] == b"https://robot:8460/board?run=red"
    assert headers[b"set-cookie"] == b"fwk-web-8460=reading; Path=/; HttpOnly; SameSite=Strict; Secure"
    assert ask(REMOTE, "robot:8460", query="token=guess")[1][0]["status"] == 403


def test_links_name_host_and_role() -> None:
    assert LOCAL.links() == {Role.STEER: "http://127.0.0.1:8460/"}
    assert REMOTE.links()[Role.READ] == "https://robot:8460/?token=reading"
    assert list(new_tokens(True).values()) == [Role.READ]
    assert len(set(new_tokens(False))) == 2


@pytest.mark.parametrize(
    ("address", "own"),
    [
        ("127.0.0.1", True),
        ("127.8.0.1", True),
        ("::1", True),
        ("localhost", True),
        ("0.0.0.0", False),
        ("robot", False),
    ],
)
def test_only_loopback_addresses_are_local(address: str, own: bool) -> None:
    assert is_loopback(address) is own


@pytest.mark.parametrize("address", ["127.0.0.1", "::1"])
def test_the_kernel_names_the_user_of_a_connection(address: str) -> None:
    with socket.create_server((address, 0), family=socket.AF_INET6 if ":" in address else socket.AF_INET) as server:
        port = server.getsockname()[1]
        with socket.create_connection((address, port)) as client:
            own = client.getsockname()[:2]
            assert user_of(own, (address, port)) == os.geteuid()
            assert user_of((address, own[1]), (address, port + 1)) is None
    assert user_of(("not an address", 1), (address, port)) is None
