"""Services of a program: requests and calls have numbers of their own, which its answers name."""

from copy import copy
from typing import Any, NamedTuple

from fwk.component.calls import Call, Calls
from fwk.component.child_process import ProgramError
from fwk.component.services import WIRE, Request, RequestState, Serves, ServiceError
from fwk.lcm import messages
from lcmtypes.core import answer_t

_ANSWERS = {
    state.value: state
    for state in (RequestState.DONE, RequestState.ACCEPTED, RequestState.REJECTED, RequestState.FAILED)
}
_STATES = {wire: state for state, wire in WIRE.items()}


class ProgramAnswer(NamedTuple):
    """Answer of a program to a request."""

    number: int
    state: RequestState
    reason: str
    reply: Any


class ServedPort:
    """A service that a program offers."""

    def __init__(self, name: str, service: Serves[Any, Any]) -> None:
        self.message_type: type[Any] = type(service._empty())
        self._name = name
        self._service = service
        self._number = 0
        self._open: dict[int, Request[Any, Any]] = {}
        self._fresh: list[tuple[int, Request[Any, Any]]] = []

    def begin(self) -> None:
        """Takes the requests of an iteration."""
        self._fresh = []
        for request in self._service:
            self._number += 1
            self._open[self._number] = request
            self._fresh.append((self._number, request))

    def plain(self) -> list[Any]:
        """Returns the requests of the iteration as plain values."""
        return [
            {"id": number, "sender": each.sender, "request": messages.to_dict(each.value)}
            for number, each in self._fresh
        ]

    def encoded(self) -> list[bytes]:
        """Returns them as LCM messages: their headers have the number and the sender."""
        made = []
        for number, request in self._fresh:
            value = copy(request.value)
            value.header = copy(value.header)
            value.header.sequence, value.header.writer = number, request.sender
            made.append(messages.encode(value, self._name))
        return made

    def answer_of(self, members: dict[str, Any], reply: Any) -> ProgramAnswer:
        """Returns the answer that plain values are, with its reply.

        Raises:
            ProgramError: the values are not an answer.
        """
        number, word, reason = members.get("id"), members.get("state", "done"), members.get("reason", "")
        if unknown := sorted(members.keys() - {"id", "state", "reason", "reply"}):
            raise ProgramError(f"'{self._name}' of the answer: '{unknown[0]}' is not id, state, reason or reply")
        if word not in _ANSWERS or not isinstance(reason, str) or type(number) is not int:
            right = '{"id": 1, "state": "done", "reply": {}}; states are done, accepted, rejected and failed'
            raise ProgramError(f"'{self._name}' of the answer is {members}; an answer to a request is {right}")
        return ProgramAnswer(number, _ANSWERS[word], reason, reply)

    def take(self, answer: Any) -> None:
        """Takes an answer of the program, or the LCM message that it is.

        Raises:
            ProgramError: no request has this number, or it cannot be answered in this way.
        """
        if not isinstance(answer, ProgramAnswer):
            said: answer_t = answer.answer
            state = _STATES.get(said.state, RequestState.SENT)
            answer = ProgramAnswer(said.sequence, state, said.reason, answer)
        request = self._open.get(answer.number)
        if request is None:
            there = ", ".join(map(str, self._open)) or "none"
            raise ProgramError(f"'{self._name}' of the answer: no open request {answer.number}; open are: {there}")
        try:
            if answer.state is RequestState.DONE:
                request.reply = answer.reply
                request.done()
            elif answer.state is RequestState.ACCEPTED:
                request.accept()
            elif answer.state is RequestState.REJECTED:
                request.reject(answer.reason)
            elif answer.state is RequestState.FAILED:
                request.fail(answer.reason)
            else:
                raise ProgramError(f"'{self._name}' of the answer: a request cannot be {answer.state}")
        except ServiceError as error:
            raise ProgramError(f"'{self._name}' of the answer: {error}") from error
        if request.finished:
            del self._open[answer.number]


class CalledPort:
    """A service that a program uses."""

    def __init__(self, name: str, calls: Calls[Any, Any]) -> None:
        self.message_type: type[Any] = type(calls.value)
        self._name = name
        self._calls = calls
        self._number = 0
        self._open: dict[int, tuple[Call[Any], RequestState]] = {}  # with the state that the program knows
        self._fresh: list[tuple[int, Call[Any]]] = []

    def begin(self) -> None:
        """Takes the answers of an iteration."""
        self._fresh = [(number, call) for number, (call, known) in self._open.items() if call.state is not known]
        for number, call in self._fresh:
            self._open[number] = call, call.state
            if call.finished:
                del self._open[number]

    def plain(self) -> list[Any]:
        """Returns the calls whose state has changed as plain values."""
        made = []
        for number, call in self._fresh:
            said: dict[str, Any] = {"id": number, "state": call.state.value, "reason": call.reason}
            made.append({**said, "reply": messages.to_dict(call.reply)} if call.done else said)
        return made

    def encoded(self) -> list[bytes]:
        """Returns them as replies; a call that timed out is an expired one there."""
        made = []
        for number, call in self._fresh:
            reply = copy(call.reply if call.done else self._calls._empty())
            reply.answer = copy(reply.answer)
            reply.answer.sequence, reply.answer.reason = number, call.reason
            reply.answer.state = WIRE.get(call.state, answer_t.EXPIRED)
            made.append(messages.encode(reply, self._name))
        return made

    def take(self, message: Any) -> None:
        """Makes a call of the program.

        Raises:
            ProgramError: the program calls in its first request.
        """
        self._calls.value = message
        try:
            call = self._calls.call()
        except ServiceError as error:
            raise ProgramError(str(error)) from error
        self._number += 1
        self._open[self._number] = call, RequestState.SENT


ServicePort = ServedPort | CalledPort
