"""The request aspect: commands whose last answer is a typed reply."""

from typing import Any, Generic, TypeVar

from fwk.component.commands import Command, CommandState, Queue, Source
from fwk.component.sending import TIMEOUT_S, Each, Future, Outbox
from fwk.lcm.messages import Header

Q = TypeVar("Q")
R = TypeVar("R")


class Request(Command[Q], Generic[Q, R]):
    """One request: `value` says what is asked; fill `reply`, then `done()` sends it."""

    def __init__(self, queue: Queue[Any], source: Source[Q], header: Header, data: bytes) -> None:
        super().__init__(queue, source, header, data)
        self.reply: R = queue.empty()

    def _message(self) -> Any:
        return self.reply if self.state is CommandState.DONE else super()._message()


class Serves(Queue[Request[Q, R]], Generic[Q, R]):
    """The requests to a component that answers them.

    `for request in self.path: request.reply.length_m = ...; request.done()`
    """

    def _command(self, source: Source[Any], header: Header, data: bytes) -> Request[Q, R]:
        return Request(self, source, header, data)


class Call(Future, Generic[R]):
    """What has become of a request. `reply` is the type's zero until it is done."""

    def __init__(self, sequence: int, timeout_us: int, empty: R) -> None:
        super().__init__(sequence, timeout_us)
        self.reply = empty

    def take(self, message: Any) -> None:
        """For the framework: an answer has come."""
        super().take(message)
        if self.done:
            self.reply = message


class Calls(Outbox[Q, Call[R]], Generic[Q, R]):
    """Asks the component that answers such requests.

    `self.path.value.x_m = 3.0; self.asked = self.path.call()`, and in later iterations `self.asked.reply`.
    """

    def call(self, timeout_s: float = TIMEOUT_S, expires_s: float | None = None) -> Call[R]:
        """Sends the value as it is now, at the end of the iteration.

        The future ends after `timeout_s` of logical time at the latest. The request is not begun after `expires_s`; if
        that is not said, not after its sender has given up.

        Raises:
            MessageError: a field holds something that its type cannot.
            CommandError: a time that cannot be, or `init`, which has none.
        """
        return self._send(timeout_s, expires_s)

    def _future(self, sequence: int, timeout_us: int) -> Call[R]:
        return Call(sequence, timeout_us, self.empty())


class CallsEach(Each[Calls[Q, R]], Generic[Q, R]):
    """Asks many components, by namespace: each that answers such requests."""
