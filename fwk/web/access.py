"""Admits requests to the console: checks host, origin and user or token, and gives each request its role."""

import hmac
import ipaddress
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass, field
from enum import StrEnum
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from fwk.control.address import obeys
from fwk.web.peer import user_of

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]
TOKEN = "token"
"""Name of the parameter of links that carries a token."""
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; connect-src 'self'; frame-ancestors 'none'; base-uri 'self'; form-action 'self'"
)
_HEADERS = [
    (b"content-security-policy", _POLICY.encode()),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"x-frame-options", b"DENY"),
]


class Role(StrEnum):
    """Rights of a browser."""

    STEER = "steer"
    READ = "read"


@dataclass(frozen=True)
class Access:
    """Rules for access to the console.

    On a loopback address the kernel names the user of each connection, and only the console's own user and root are
    admitted. On other addresses a token is needed; it comes with the link and stays in a cookie.
    """

    address: str
    port: int
    read_only: bool = False
    """Whether every browser has the role `READ`."""
    names: tuple[str, ...] = ()
    """Further names of the machine in links."""
    tokens: dict[str, Role] = field(default_factory=dict)

    @property
    def local(self) -> bool:
        """Whether only this machine reaches the console."""
        return is_loopback(self.address)

    @property
    def scheme(self) -> str:
        """The scheme of links: beyond this machine always encrypted."""
        return "http" if self.local else "https"

    @property
    def hosts(self) -> frozenset[str]:
        """Values of the header `Host` that are answered; others are attempts to rebind a name."""
        own = ["127.0.0.1", "localhost", "[::1]"] if self.local else [bracketed(self.address)]
        return frozenset(f"{name.lower()}:{self.port}" for name in (*own, *self.names))

    def role_of_token(self, token: str) -> Role | None:
        """Returns the role that a token gives; None if it is unknown."""
        found = None
        for known, role in self.tokens.items():
            if hmac.compare_digest(known.encode(), token.encode()):
                found = role
        return Role.READ if found and self.read_only else found

    def links(self) -> dict[Role, str]:
        """Returns the links to print, by role."""
        name = bracketed((self.names or (self.address,))[0])
        base = f"{self.scheme}://{name}:{self.port}/"
        if self.local:
            return {Role.READ if self.read_only else Role.STEER: base}
        return {role: f"{base}?{TOKEN}={token}" for token, role in self.tokens.items()}


def new_tokens(read_only: bool) -> dict[str, Role]:
    """Makes a token for each role; without steering only the token for reading."""
    roles = (Role.READ,) if read_only else (Role.STEER, Role.READ)
    return {secrets.token_urlsafe(24): role for role in roles}


def is_loopback(address: str) -> bool:
    """Tells whether only this machine can reach an address."""
    if address == "localhost":
        return True
    try:
        return ipaddress.ip_address(address).is_loopback
    except ValueError:
        return False


def bracketed(address: str) -> str:
    """Returns an address as links contain it."""
    return f"[{address}]" if ":" in address else address


class Gate:
    """Passes requests that are admitted on to the application; their role is in the state of the request."""

    def __init__(self, app: App, access: Access, user: Callable[..., int | None] = user_of) -> None:
        self._app = app
        self._access = access
        self._user = user
        self._cookie = f"fwk-web-{access.port}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handles a request or a connection."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        headers = {name.decode("latin-1").lower(): value.decode("latin-1") for name, value in scope["headers"]}
        wrong = self._wrong_names(headers)
        if wrong:
            await _refuse(scope, send, wrong)
            return
        query = dict(parse_qsl(scope.get("query_string", b"").decode("latin-1")))
        token = query.pop(TOKEN, "")
        if token and self._access.role_of_token(token) and scope["type"] == "http":
            await self._remember(scope, send, token, query, headers["host"])
            return
        role = self._role(scope, headers)
        if role is None:
            await _refuse(scope, send, self._reason())
            return
        scope.setdefault("state", {})["role"] = role

        async def send_with_headers(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                message["headers"] = [*message.get("headers", []), *_HEADERS]
            await send(message)

        await self._app(scope, receive, send_with_headers)

    def _wrong_names(self, headers: dict[str, str]) -> str:
        host = headers.get("host", "").lower()
        if host not in self._access.hosts:
            return f"this console is not '{host}'; it answers to {', '.join(sorted(self._access.hosts))}"
        origin = headers.get("origin")
        if origin is not None and origin.lower() != f"{self._access.scheme}://{host}":
            return f"pages of '{origin}' cannot use this console"
        if headers.get("sec-fetch-site", "none") == "cross-site" and headers.get("sec-fetch-mode") != "navigate":
            return "pages of other sites cannot use this console"
        return ""

    def _role(self, scope: Scope, headers: dict[str, str]) -> Role | None:
        if self._access.local:
            client, server = scope.get("client"), scope.get("server")
            uid = self._user(tuple(client), tuple(server)) if client and server else None
            if uid is None or not obeys(uid):
                return None
            return Role.READ if self._access.read_only else Role.STEER
        try:
            cookies = SimpleCookie(headers.get("cookie", ""))
        except CookieError:
            return None
        found = cookies.get(self._cookie)
        return self._access.role_of_token(found.value) if found else None

    def _reason(self) -> str:
        if self._access.local:
            return "only the user who started this console, and root, may use it"
        return "open the link with the token that 'fwk web' has printed"

    async def _remember(self, scope: Scope, send: Send, token: str, query: dict[str, str], host: str) -> None:
        """Moves a token from the link into a cookie, so that it appears in no history."""
        path = quote(scope["path"]) + (f"?{urlencode(query)}" if query else "")
        there = f"{self._access.scheme}://{host}{path}"
        cookie = f"{self._cookie}={token}; Path=/; HttpOnly; SameSite=Strict" + (
            "" if self._access.local else "; Secure"
        )
        headers = [(b"location", there.encode()), (b"set-cookie", cookie.encode()), *_HEADERS]
        await send({"type": "http.response.start", "status": 303, "headers": headers})
        await send({"type": "http.response.body", "body": b""})


async def _refuse(scope: Scope, send: Send, reason: str) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 4403, "reason": reason[:100]})
        return
    headers = [(b"content-type", b"text/plain; charset=utf-8"), *_HEADERS]
    await send({"type": "http.response.start", "status": 403, "headers": headers})
    await send({"type": "http.response.body", "body": f"fwk web: {reason}\n".encode()})
