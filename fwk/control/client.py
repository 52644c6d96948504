"""Client side of the control sockets: sends requests to a run. Imports nothing heavy."""

import contextlib
import json
import socket
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from typing import Any, Self

from fwk.clock import US_PER_S, monotonic_us
from fwk.control import address

TIMEOUT_S = 5.0
_CHUNK = 64 << 10
_DESCRIPTORS_MAX = 4
_ANSWER_MAX_BYTES = 64 << 20
LOOK_S = 1.0
"""Time that a run has to say something about itself."""
_NOTICE_US = US_PER_S
notice: ContextVar[Callable[[str], None] | None] = ContextVar("notice", default=None)
"""Takes a text about a request that has had no answer for a second; without it, such requests wait silently."""


class ControlError(Exception):
    """A run cannot be asked; the text gives the reason and the remedy."""


class NoAnswerError(ControlError):
    """A run has not answered in time; the text names the components that its main loop waits for."""


class RefusedError(ControlError):
    """A run refuses a request, or the named run does not exist."""


class Client:
    """Connection to the supervisor or gateway of a run.

    Raises:
        ControlError: no process listens, or the socket belongs to another user.
    """

    def __init__(self, socket_address: str, timeout_s: float = TIMEOUT_S) -> None:
        self._rest = b""
        self._descriptors: list[int] = []
        self._address = socket_address
        self._timeout_s = timeout_s
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(timeout_s)
        try:
            self._socket.connect(socket_address)
            self.pid, self.uid = address.peer_of(self._socket)
        except OSError as error:
            self._socket.close()
            raise ControlError(f"the run does not answer ({error.strerror}); it may just be ending") from error
        if not address.trusts(self.uid):
            self._socket.close()
            name = socket_address.lstrip("\0")
            raise ControlError(f"the socket {name} belongs to user {self.uid}, not to you; nothing was sent to it")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def ask(self, verb: str, timeout_s: float | None = None, **fields: Any) -> dict[str, Any]:
        """Sends a request and waits for its answer.

        Raises:
            ControlError: refused, no answer in time, or not an answer.
        """
        within_s = timeout_s or self._timeout_s
        self.send(verb, **fields)
        try:
            return self._patient(monotonic_us() + round(within_s * US_PER_S))
        except TimeoutError as error:
            remedy = self._remedy() if verb != "status" else ""
            raise NoAnswerError(f"{self._run()} has not answered within {within_s:g} s{remedy}") from error
        except EOFError as error:
            raise ControlError("the run has ended") from error

    def follow(
        self, verb: str, within_s: float | None = None, notices: bool = False, **fields: Any
    ) -> Iterator[dict[str, Any]]:
        """Sends a request and yields all its answers until the run ends or `within_s` has passed.

        With `notices`, each answer is expected within a second, as that of `ask` is.

        Raises:
            ControlError: refused, or not an answer.
        """
        self.send(verb, **fields)
        end_us = None if within_s is None else monotonic_us() + round(within_s * US_PER_S)
        lacking = "answer"
        while True:
            try:
                yield self._patient(end_us, lacking) if notices else self.answer(end_us)
            except (TimeoutError, EOFError):
                return
            lacking = "further answer"

    def _patient(self, end_us: int | None, lacking: str = "answer") -> dict[str, Any]:
        """Returns the next answer; after a second without it, says what is `lacking`, and what the run waits for."""
        tell, first_us = notice.get(), monotonic_us() + _NOTICE_US
        if tell and (end_us is None or first_us < end_us):
            try:
                return self.answer(first_us)
            except TimeoutError:
                waits = self._waits_for()
                so_far = f"yet; the run waits for {', '.join(waits)}" if waits else "of the run yet"
                tell(f"no {lacking} {so_far}")
        return self.answer(end_us)

    def send(self, verb: str, **fields: Any) -> None:
        """Sends a request."""
        with contextlib.suppress(BrokenPipeError):  # the connection was refused: the reason can still be read
            self._socket.sendall(json.dumps({"verb": verb, **fields}).encode() + b"\n")

    def answer(self, end_us: int | None) -> dict[str, Any]:
        """Returns the next answer.

        Raises:
            EOFError: the connection has ended.
            TimeoutError: `end_us` has passed.
            ControlError: the run refuses, or what came is not an answer.
        """
        parts, size, descriptors = [self._rest], len(self._rest), self._descriptors
        while b"\n" not in parts[-1]:
            self._socket.settimeout(None if end_us is None else max(0, end_us - monotonic_us()) / US_PER_S)
            try:
                data, found, _, _ = socket.recv_fds(self._socket, _CHUNK, _DESCRIPTORS_MAX)
                descriptors += found
            except (BlockingIOError, TimeoutError) as error:
                self._rest = b"".join(parts)
                raise TimeoutError from error
            except ConnectionError:
                data = b""
            if not data:
                raise EOFError
            parts.append(data)
            size += len(data)
            if size > _ANSWER_MAX_BYTES:
                raise ControlError(f"{self._run()} sends an answer without end")
        line, _, self._rest = b"".join(parts).partition(b"\n")
        self._descriptors = []
        answer = self._read(line)
        if not answer.get("ok"):
            raise RefusedError(_plain(str(answer.get("error"))))
        if descriptors:
            answer["descriptors"] = descriptors
        return answer

    def _read(self, line: bytes) -> "_Answer":
        """Returns an answer; any user can bind a control socket, and root asks the sockets of all users."""
        try:
            answer = json.loads(line, object_hook=_Answer)
        except (ValueError, RecursionError) as error:
            raise ControlError(f"{self._run()} sends something that is not an answer") from error
        if not isinstance(answer, _Answer):
            raise ControlError(f"{self._run()} sends something that is not an answer")
        return answer

    def _run(self) -> str:
        """Names the process at the other end."""
        process = f"pid {self.pid}" if self.pid else "a process that is not visible from here"
        return f"the run at @{self._address[1:]} ({process})"

    def _remedy(self) -> str:
        """Names the components that keep the current tick from ending; most requests take effect after it."""
        waits_for = self._waits_for()
        if not waits_for:
            return ""
        hint = "" if waits_for == ["gateway"] else ": a component that does not come back can be stopped"
        return f"; its loop waits for {', '.join(waits_for)}{hint}"

    def _waits_for(self) -> list[str]:
        """Returns the components that the main loop waits for, as its supervisor says on another connection."""
        try:
            with Client(address.supervisor_beside(self._address), LOOK_S) as other:
                other.send("status")
                found: list[str] = other.answer(monotonic_us() + round(LOOK_S * US_PER_S)).get("waits_for", [])
                return found
        except (ControlError, TimeoutError, EOFError):
            return []


class _Answer(dict[str, Any]):
    """An answer, or a part of one; a program that is not a run of this version may leave keys out."""

    def __missing__(self, key: str) -> Any:
        raise ControlError(f"the answer of the run lacks '{key}'; another version of fwk has started it")


def _plain(text: str) -> str:
    """Replaces characters that would steer the terminal."""
    return "".join(each if each.isprintable() or each == "\n" else "�" for each in text)
