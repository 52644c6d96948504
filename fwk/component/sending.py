"""The commands aspect, the side that wants something done: sends commands and sees what becomes of them."""

from abc import ABC, abstractmethod
from collections.abc import ItemsView, Iterator, Mapping
from typing import Any, Generic, TypeVar

from fwk.clock import SECONDS_MAX, US_PER_S, Clock
from fwk.component.channels import Reads, Writes
from fwk.component.commands import QUEUE_MAX, WIRE, CommandError, CommandState
from lcmtypes.core import answer_t

T = TypeVar("T")
TIMEOUT_S = 10.0

_STATES = {**{wire: state for state, wire in WIRE.items()}, answer_t.FORGOTTEN: CommandState.FAILED}


def state_of(answer: answer_t) -> CommandState:
    """What an answer says has become of a command."""
    return _STATES[answer.state]


class Future:
    """What has become of a command as of this iteration; nothing changes while one runs."""

    def __init__(self, sequence: int, timeout_us: int) -> None:
        self.state = CommandState.SENT
        self.reason = ""
        self.sequence = sequence
        self.timeout_us = timeout_us
        """Logical time at which waiting for the last answer ends."""

    @property
    def finished(self) -> bool:
        """Whether nothing more is to be expected."""
        return self.state not in (CommandState.SENT, CommandState.ACCEPTED)

    @property
    def done(self) -> bool:
        """Whether it was carried out."""
        return self.state is CommandState.DONE

    def take(self, message: Any) -> None:
        """For the framework: an answer has come."""
        answer: answer_t = message.answer
        self.state, self.reason = state_of(answer), answer.reason

    def end(self, state: CommandState, reason: str) -> None:
        """For the framework: no answer can come any more, or none is waited for."""
        self.state, self.reason = state, reason


F = TypeVar("F", bound=Future)


class Outbox(ABC, Generic[T, F]):
    """What `Sends` and `Calls` have in common: change `value`, send it, keep the future."""

    def __init__(self, name: str, sender: str, clock: Clock, writes: Writes[T], answers: Reads[Any]) -> None:
        self.name = name
        self.value: T = writes.value
        self._sender = sender
        self._clock = clock
        self._writes = writes
        self._answers = answers
        self._open: dict[int, F] = {}

    @property
    def pending(self) -> list[F]:
        """Futures of commands that are not finished, the oldest first."""
        return list(self._open.values())

    def begin(self) -> None:
        """For the framework: takes in what the frozen inputs hold."""
        if not self._open:
            return
        for message in self._answers.fresh:
            if message.answer.sender == self._sender:
                self._hear(message)
        for future in self.pending:
            if self._clock.now_us > future.timeout_us:
                del self._open[future.sequence]
                heard = "was accepted and not finished" if future.state is CommandState.ACCEPTED else "was not answered"
                future.end(CommandState.TIMED_OUT, f"{self.name}: {heard} in time")

    def end(self) -> None:
        """For the framework: the sender was stopped; what it has sent goes on without it."""

    def empty(self) -> Any:
        """For the framework: an answer without content."""
        return self._answers.message_type()

    @abstractmethod
    def _future(self, sequence: int, timeout_us: int) -> F:
        """What becomes of the message with this number."""

    def _send(self, timeout_s: float, expires_s: float | None) -> F:
        now_us = self._clock.now_us
        if not self._clock.tick:
            raise CommandError(f"{self.name}: {self._sender} has no time yet in init(); send in loop()")
        timeout_us = now_us + self._us("timeout_s", timeout_s)
        if len(self._open) >= QUEUE_MAX:
            future = self._future(0, timeout_us)
            future.end(CommandState.REJECTED, f"queue full: {QUEUE_MAX} commands to {self.name} are not finished")
            return future
        message: Any = self.value
        message.command.expires_us = timeout_us if expires_s is None else now_us + self._us("expires_s", expires_s)
        self._writes.value = self.value
        self._writes.write()
        future = self._future(message.header.sequence, timeout_us)
        self._open[future.sequence] = future
        return future

    def _us(self, name: str, seconds: float) -> int:
        if not 0.0 <= seconds <= SECONDS_MAX:
            raise CommandError(f"{self.name}: {name} is {seconds}; it should be from 0 to {SECONDS_MAX:g} s")
        return round(seconds * US_PER_S)

    def _hear(self, message: Any) -> None:
        answer: answer_t = message.answer
        if answer.state == answer_t.FORGOTTEN:
            meant = [future for future in self.pending if future.sequence <= answer.sequence]
        else:
            meant = [future for future in (self._open.get(answer.sequence),) if future]
        for future in meant:
            future.take(message)
            if future.finished:
                del self._open[future.sequence]


class Sends(Outbox[T, Future], Generic[T]):
    """Sends commands to the component that carries them out.

    `self.kick.value.speed_m_s = 3.0; self.kicking = self.kick.send()`, and in later iterations `self.kicking.done`.
    """

    def send(self, timeout_s: float = TIMEOUT_S, expires_s: float | None = None) -> Future:
        """Sends the value as it is now, at the end of the iteration.

        The future ends after `timeout_s` of logical time at the latest. The command is not begun after `expires_s`; if
        that is not said, not after its sender has given up.

        Raises:
            MessageError: a field holds something that its type cannot.
            CommandError: a time that cannot be, or `init`, which has none.
        """
        return self._send(timeout_s, expires_s)

    def _future(self, sequence: int, timeout_us: int) -> Future:
        return Future(sequence, timeout_us)


S = TypeVar("S")


class Each(Mapping[str, S], Generic[S]):
    """Ports of many instances by namespace, in alphabetical order."""

    def __init__(self, ports: Mapping[str, S]) -> None:
        self._ports = dict(sorted(ports.items()))

    def __getitem__(self, key: str) -> S:
        return self._ports[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._ports)

    def __len__(self) -> int:
        return len(self._ports)

    def items(self) -> ItemsView[str, S]:
        """Pairs of namespace and port."""
        return self._ports.items()


class SendsEach(Each[Sends[T]], Generic[T]):
    """Sends commands to many owners, by namespace: one for each that carries them out."""
