"""The side that asks: finds the run and talks to it."""

import contextlib
import json
import socket
from collections.abc import Iterator
from typing import Any, Self

from fwk.clock import US_PER_S, monotonic_us
from fwk.control import address

TIMEOUT_S = 5.0
_CHUNK = 64 << 10
_DESCRIPTORS_MAX = 4


class ControlError(Exception):
    """The run cannot be asked, or refuses; says why and what would be right."""


class NoAnswerError(ControlError):
    """The run has not answered in time; says whom its loop waits for."""


class RefusedError(ControlError):
    """The run was asked for something that it cannot do, or that does not exist."""


class Client:
    """A connection to a run's supervisor or gateway."""

    def __init__(self, socket_address: str, timeout_s: float = TIMEOUT_S) -> None:
        self._rest = b""
        self._address = socket_address
        self._timeout_s = timeout_s
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._socket.settimeout(timeout_s)
        try:
            self._socket.connect(socket_address)
        except OSError as error:
            self._socket.close()
            raise ControlError(f"the run does not answer ({error.strerror}); it is perhaps just ending") from error

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._socket.close()

    def ask(self, verb: str, timeout_s: float | None = None, **fields: Any) -> dict[str, Any]:
        """Sends a request and waits for its answer.

        Raises:
            ControlError: refused, or no answer in time.
        """
        self._send(verb, fields)
        try:
            return self._answer(timeout_s or self._timeout_s)
        except NoAnswerError as error:
            raise NoAnswerError(f"{error}{self._waits() if verb != 'status' else ''}") from error

    def follow(self, verb: str, within_s: float | None = None, **fields: Any) -> Iterator[dict[str, Any]]:
        """Sends a request and gives all its answers, until the run ends or that much time has passed.

        Raises:
            ControlError: refused.
        """
        self._send(verb, fields)
        end_us = None if within_s is None else monotonic_us() + round(within_s * US_PER_S)
        while True:
            try:
                yield self._answer(None, end_us)
            except EOFError:
                return

    def _send(self, verb: str, fields: dict[str, Any]) -> None:
        with contextlib.suppress(BrokenPipeError):  # refused: the reason can be read
            self._socket.sendall(json.dumps({"verb": verb, **fields}).encode() + b"\n")

    def _answer(self, timeout_s: float | None, end_us: int | None = None) -> dict[str, Any]:
        """The next answer. EOFError: there is none any more, or none before `end_us`."""
        parts, descriptors = [self._rest], list[int]()
        while b"\n" not in parts[-1]:
            left_s = timeout_s if end_us is None else max(1, end_us - monotonic_us()) / US_PER_S
            self._socket.settimeout(left_s)
            try:
                data, found, _, _ = socket.recv_fds(self._socket, _CHUNK, _DESCRIPTORS_MAX)
                descriptors += found
            except TimeoutError as error:
                if end_us is not None:
                    raise EOFError from error
                raise NoAnswerError(f"the run has not answered within {timeout_s:g} s") from error
            except ConnectionError:
                data = b""
            if not data:
                if timeout_s is None:
                    raise EOFError
                raise ControlError("the run has ended")
            parts.append(data)
        line, _, self._rest = b"".join(parts).partition(b"\n")
        answer: dict[str, Any] = json.loads(line)
        if not answer.get("ok"):
            raise RefusedError(str(answer.get("error")))
        return {**answer, "descriptors": descriptors} if descriptors else answer

    def _waits(self) -> str:
        """For what happens at a tick's end only: what keeps the tick from ending."""
        try:
            with Client(self._address, 1.0) as other:
                waits_for = other.ask("status").get("waits_for", [])
        except ControlError:
            return ""
        if not waits_for:
            return ""
        hint = "" if waits_for == ["gateway"] else ": what does not come back can be stopped"
        return f"; its loop waits for {', '.join(waits_for)}{hint}"


def find_run(bus_port: int | None) -> int:
    """The bus port of the run that is meant: the one that is named, or the only one.

    Raises:
        ControlError: there is none, or several.
    """
    ports = address.running()
    if bus_port is not None:
        if bus_port not in ports:
            others = f"; there is one with --bus-port {_listed(ports)}" if ports else ""
            raise ControlError(f"no run on this machine has --bus-port {bus_port}{others}")
        return bus_port
    if not ports:
        raise ControlError("nothing runs on this machine; start something with: fwk-launch FILE")
    if len(ports) > 1:
        raise ControlError(f"several runs are on this machine; say which: --bus-port {_listed(ports)}")
    return ports[0]


def supervisor(bus_port: int | None) -> Client:
    """A connection to the supervisor of the run that is meant.

    Raises:
        ControlError: as `find_run`.
    """
    return Client(address.supervisor_address(find_run(bus_port)))


def gateway(bus_port: int | None) -> Client:
    """A connection to the gateway of the run that is meant.

    Raises:
        ControlError: as `find_run`.
    """
    return Client(address.gateway_address(find_run(bus_port)))


def _listed(ports: list[int]) -> str:
    return " or ".join(f"{port}{_name_of(port)}" for port in ports)


def _name_of(port: int) -> str:
    try:
        with Client(address.supervisor_address(port), 1.0) as client:
            run = client.ask("run")
            return f" ({run['plan']}, pid {run['pid']})"
    except ControlError:
        return ""
