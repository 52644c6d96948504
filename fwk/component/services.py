"""Services, the side that offers them: a queue of typed requests, and an answer to each."""

from collections import deque
from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import Any, Generic, cast

from typing_extensions import TypeVar

from fwk.clock import Clock
from fwk.component.channels import Reads, Writes
from fwk.lcm import messages
from fwk.lcm.messages import Header
from fwk.model.service_channels import client_of
from lcmtypes.core import acknowledgement_t, answer_t

Q = TypeVar("Q")
R = TypeVar("R", default=acknowledgement_t)
QUEUE_MAX = 64
"""Unfinished requests of one client to one service; further ones are rejected."""


class RequestState(StrEnum):
    """States of a request."""

    SENT = "sent"
    ACCEPTED = "accepted"
    DONE = "done"
    REJECTED = "rejected"
    FAILED = "failed"
    EXPIRED = "expired"
    TIMED_OUT = "timed out"


WIRE = {
    RequestState.ACCEPTED: answer_t.ACCEPTED,
    RequestState.DONE: answer_t.DONE,
    RequestState.REJECTED: answer_t.REJECTED,
    RequestState.FAILED: answer_t.FAILED,
    RequestState.EXPIRED: answer_t.EXPIRED,
}
"""States as numbers in `answer_t`."""


class ServiceError(Exception):
    """A request cannot be sent or answered in this way; the text names the request and the reason."""


class RequestReader(Reads[Q]):
    """Reader of one client's requests. They stay encoded until the service takes them."""

    def __init__(self, channel: str, message_type: type[Q]) -> None:
        super().__init__(channel, message_type)
        self.arrived: list[bytes] = []
        self.client = client_of(channel)

    def _freeze(self, fresh: list[bytes]) -> None:
        super()._freeze(fresh)
        self.arrived = fresh


class Request(Generic[Q, R]):
    """One request: `value` is its content, `accept`, `done`, `reject` and `fail` answer it.

    The answer may come in a later iteration than the request. Every answer but `accept` is final. `done` sends `reply`,
    which is to be filled first; the reply to a command has no fields.
    """

    def __init__(self, service: "Serves[Any, Any]", source: RequestReader[Q], header: Header, data: bytes) -> None:
        self.state = RequestState.SENT
        self.sender = source.client
        """Full name of the component that sent the request; `outside` for tools."""
        self.sequence = header.sequence
        """Identifies the request in the run, together with the sender."""
        self.sent_us = header.time_us
        """Logical time at which the request was sent."""
        self.value: Q = cast(Q, messages.decode(cast(Any, source.message_type), data, source.channel))
        self.reply: R = service._empty()
        self._service = service

    @property
    def expires_us(self) -> int:
        """Logical time after which the request must not begin; 0: never."""
        return int(cast(Any, self.value).command.expires_us)

    @property
    def finished(self) -> bool:
        """Whether the final answer was given."""
        return self.state not in (RequestState.SENT, RequestState.ACCEPTED)

    def accept(self) -> None:
        """Tells the sender that the request is being carried out and takes longer than this iteration."""
        self._answer(RequestState.ACCEPTED)

    def done(self) -> None:
        """Tells the sender that the request was carried out, and sends `reply`."""
        self._answer(RequestState.DONE)

    def reject(self, reason: str) -> None:
        """Tells the sender that the request will not be carried out."""
        self._answer(RequestState.REJECTED, reason)

    def fail(self, reason: str) -> None:
        """Tells the sender that the request was begun and could not be carried out."""
        self._answer(RequestState.FAILED, reason)

    def _answer(self, state: RequestState, reason: str = "") -> None:
        if self.finished or state == self.state:
            raise ServiceError(
                f"{self._service.name}: request {self.sequence} of {self.sender} is already {self.state} "
                f"and cannot be {state}"
            )
        self.state = state
        message = self.reply if state is RequestState.DONE else self._service._empty()
        self._service._answer(message, WIRE[state], self.sender, self.sequence, reason)
        if self.finished:
            self._service._finish(self)


class Serves(Generic[Q, R]):
    """Offers a service: `kick: Serves[kick_t]` carries out commands, `path: Serves[path_request_t, path_t]` replies.

    `for request in self.path: request.reply.length_m = 2.0; request.done()`

    Iterating takes requests out of the queue, each once, in the order of tick, stage, sender and sequence number.
    Requests that are not taken stay in the queue. After a restart, requests that are visible in the first iteration
    fail, because the previous process may have begun them.
    """

    def __init__(
        self, name: str, owner: str, clock: Clock, sources: Mapping[str, RequestReader[Q]], answers: Writes[Any]
    ) -> None:
        self.name = name
        self.expired = 0
        """Number of requests that were not begun in time."""
        self.refused = 0
        """Number of requests that found the queue full."""
        self.open: list[Request[Q, R]] = []
        """Requests that were taken and are not finished, oldest first."""
        self._owner = owner
        self._clock = clock
        self._sources = [sources[channel] for channel in sorted(sources)]
        self._answers = answers
        self._waiting: deque[Request[Q, R]] = deque()
        self._unfinished = dict.fromkeys((source.client for source in self._sources), 0)
        self._newest = dict.fromkeys(self._unfinished, 0)  # newest sequence number of each client
        self._fresh_start = True

    def __iter__(self) -> Iterator[Request[Q, R]]:
        while request := self.take():
            yield request

    def take(self) -> Request[Q, R] | None:
        """Takes the next request out of the queue; None if the queue is empty."""
        if not self._waiting:
            return None
        self.open.append(self._waiting.popleft())
        return self.open[-1]

    @property
    def waiting(self) -> tuple[Request[Q, R], ...]:
        """Requests in the queue, in their order; one that is rejected here leaves the queue."""
        return tuple(self._waiting)

    def __len__(self) -> int:
        """Number of requests in the queue."""
        return len(self._waiting)

    def _begin(self) -> None:
        """Begins an iteration: takes in the requests of the frozen inputs."""
        arrived = [(source, Header.of(data), data) for source in self._sources for data in source.arrived]
        if self._fresh_start:
            self._take_part()
            if self._clock.tick > 1:
                self._forget()
                return
        if self._waiting:
            self._expire()
        for source, header, _ in arrived:
            self._report_missing(source, header.sequence)
        arrived.sort(key=lambda each: (each[1].tick, each[1].stage, each[0].client, each[1].sequence))
        for source, header, data in arrived:
            self._queue(source, header, data)

    def _take_part(self) -> None:
        """Notes that the component takes part in the run: no later request was sent before its start."""
        self._fresh_start = False

    def _end(self) -> None:
        """Ends the service: its unfinished requests have failed."""
        waiting, self._waiting = self._waiting, deque()
        for request in [*self.open, *waiting]:
            request.fail(f"{self._owner} was stopped")

    def _answer(self, message: Any, state: int, client: str, sequence: int, reason: str) -> None:
        """Sends an answer at the end of the iteration."""
        answer: answer_t = message.answer
        answer.state, answer.sender, answer.sequence, answer.reason = state, client, sequence, reason
        self._answers.value = message
        self._answers.write()

    def _empty(self) -> Any:
        """Returns a reply without content."""
        return self._answers.message_type()

    def _finish(self, request: Request[Q, R]) -> None:
        """Releases the request's place in the queue."""
        self._unfinished[request.sender] -= 1
        self._waiting = deque(each for each in self._waiting if each is not request)
        self.open = [each for each in self.open if each is not request]

    def _report_missing(self, source: RequestReader[Q], sequence: int) -> None:
        """Answers requests that did not arrive: the owner was absent for too long, or they were lost for good."""
        newest, self._newest[source.client] = self._newest[source.client], sequence
        for missing in range(max(newest + 1, sequence - QUEUE_MAX), sequence):
            reason = f"it did not reach {self._owner}"
            self._answer(self._empty(), answer_t.FAILED, source.client, missing, reason)

    def _queue(self, source: RequestReader[Q], header: Header, data: bytes) -> None:
        if self._unfinished[source.client] >= QUEUE_MAX:
            self.refused += 1
            reason = f"queue full: {QUEUE_MAX} commands of {source.client} are not finished"
            self._answer(self._empty(), answer_t.REJECTED, source.client, header.sequence, reason)
            return
        request: Request[Q, R] = Request(self, source, header, data)
        self._unfinished[source.client] += 1
        self._keep(request)

    def _keep(self, request: Request[Q, R]) -> None:
        if 0 < request.expires_us < self._clock.now_us:
            self.expired += 1
            request._answer(RequestState.EXPIRED, "it was not begun in time")
        else:
            self._waiting.append(request)

    def _expire(self) -> None:
        waiting, self._waiting = self._waiting, deque()
        for request in waiting:
            self._keep(request)

    def _forget(self) -> None:
        """Answers all requests sent before the start; the newest of each client stands for all before it."""
        for source in self._sources:
            if source.arrived:
                newest = self._newest[source.client] = Header.of(source.arrived[-1]).sequence
                reason = f"{self._owner} was started after it had been sent"
                self._answer(self._empty(), answer_t.FORGOTTEN, source.client, newest, reason)
