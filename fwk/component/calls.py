"""Services, the client's side: sends requests and follows their answers."""

from typing import Any, Generic

from fwk.clock import SECONDS_MAX, US_PER_S, Clock
from fwk.component.channels import Reads, Writes
from fwk.component.services import QUEUE_MAX, WIRE, Q, R, RequestState, ServiceError
from lcmtypes.core import answer_t

TIMEOUT_S = 10.0

_STATES = {**{wire: state for state, wire in WIRE.items()}, answer_t.FORGOTTEN: RequestState.FAILED}


def state_of(answer: answer_t) -> RequestState:
    """Returns the state of a request after an answer."""
    return _STATES[answer.state]


class Call(Generic[R]):
    """A request as its client sees it; none of it changes during an iteration."""

    def __init__(self, sequence: int, timeout_us: int, empty: R) -> None:
        self.state = RequestState.SENT
        self.reason = ""
        """Reason for which the request was rejected or failed; otherwise empty."""
        self.reply = empty
        """The reply; the type's zero until the request is done."""
        self.sequence = sequence
        self.timeout_us = timeout_us
        """Logical time at which waiting for the final answer ends."""

    @property
    def finished(self) -> bool:
        """Whether no further answer is expected."""
        return self.state not in (RequestState.SENT, RequestState.ACCEPTED)

    @property
    def done(self) -> bool:
        """Whether the request was carried out."""
        return self.state is RequestState.DONE

    def _take(self, message: Any) -> None:
        """Takes in an answer."""
        answer: answer_t = message.answer
        self._end(state_of(answer), answer.reason)
        if self.done:
            self.reply = message

    def _end(self, state: RequestState, reason: str) -> None:
        self.state, self.reason = state, reason


class Calls(Generic[Q, R]):
    """Uses a service that another component offers: `kick: Calls[kick_t]`, `path: Calls[path_request_t, path_t]`.

    `self.kick.value.speed_m_s = 3.0; self.kicking = self.kick.call()`, and in later iterations `self.kicking.done`.
    """

    def __init__(self, name: str, client: str, clock: Clock, writes: Writes[Q], answers: Reads[Any]) -> None:
        self.name = name
        self.value: Q = writes.value
        """Content of the next request."""
        self._client = client
        self._clock = clock
        self._writes = writes
        self._answers = answers
        self._open: dict[int, Call[R]] = {}

    @property
    def pending(self) -> list[Call[R]]:
        """Calls that are not finished, oldest first."""
        return list(self._open.values())

    def call(self, timeout_s: float = TIMEOUT_S, expires_s: float | None = None) -> Call[R]:
        """Sends `value` as it is now, at the end of the iteration.

        Args:
            timeout_s: Logical time after which the call ends without a final answer, in s.
            expires_s: Logical time after which the request must not begin, in s; by default `timeout_s`.

        Returns:
            The call, which shows the answers. It is rejected at once while too many requests are unfinished.

        Raises:
            MessageError: a field holds a value that its type cannot.
            ServiceError: a time is out of range, or the call is made in `init`, where there is no time yet.
        """
        now_us = self._clock.now_us
        if not self._clock.tick:
            raise ServiceError(f"{self.name}: {self._client} has no time yet in init(); call in loop()")
        timeout_us = now_us + self._us("timeout_s", timeout_s)
        if len(self._open) >= QUEUE_MAX:
            refused: Call[R] = Call(0, timeout_us, self._empty())
            refused._end(RequestState.REJECTED, f"queue full: {QUEUE_MAX} commands to {self.name} are not finished")
            return refused
        message: Any = self.value
        message.command.expires_us = timeout_us if expires_s is None else now_us + self._us("expires_s", expires_s)
        self._writes.value = self.value
        self._writes.write()
        made: Call[R] = Call(message.header.sequence, timeout_us, self._empty())
        self._open[made.sequence] = made
        return made

    send = call  # the name of `call` in components that declare commands as `Sends`

    def _begin(self) -> None:
        """Begins an iteration: takes in the answers of the frozen inputs."""
        if not self._open:
            return
        for message in self._answers.fresh:
            if message.answer.sender == self._client:
                self._hear(message)
        for call in self.pending:
            if self._clock.now_us > call.timeout_us:
                del self._open[call.sequence]
                heard = "was accepted and not finished" if call.state is RequestState.ACCEPTED else "was not answered"
                call._end(RequestState.TIMED_OUT, f"{self.name}: {heard} in time")

    def _end(self) -> None:
        """Ends the client; its requests go on without it."""

    def _empty(self) -> Any:
        return self._answers.message_type()

    def _us(self, name: str, seconds: float) -> int:
        if not 0.0 <= seconds <= SECONDS_MAX:
            raise ServiceError(f"{self.name}: {name} is {seconds}; it should be from 0 to {SECONDS_MAX:g} s")
        return round(seconds * US_PER_S)

    def _hear(self, message: Any) -> None:
        answer: answer_t = message.answer
        if answer.state == answer_t.FORGOTTEN:
            meant = [call for call in self.pending if call.sequence <= answer.sequence]
        else:
            meant = [call for call in (self._open.get(answer.sequence),) if call]
        for call in meant:
            call._take(message)
            if call.finished:
                del self._open[call.sequence]
