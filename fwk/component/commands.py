"""The commands aspect, the side that carries out: a queue of typed commands and an answer to each."""

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Iterator, Mapping
from enum import StrEnum
from typing import Any, Generic, TypeVar, cast

from fwk.clock import Clock
from fwk.component.channels import Reads, Writes
from fwk.lcm import messages
from fwk.lcm.messages import Header
from lcmtypes.core import answer_t

T = TypeVar("T")
ANSWERS = "answers"
"""As the sender in a channel's name: what its owner answers."""
QUEUE_MAX = 64
"""Commands of one sender to one owner that are not finished; the next ones are rejected."""


class CommandState(StrEnum):
    """What has become of a command."""

    SENT = "sent"
    ACCEPTED = "accepted"
    DONE = "done"
    REJECTED = "rejected"
    FAILED = "failed"
    EXPIRED = "expired"
    TIMED_OUT = "timed out"


WIRE = {
    CommandState.ACCEPTED: answer_t.ACCEPTED,
    CommandState.DONE: answer_t.DONE,
    CommandState.REJECTED: answer_t.REJECTED,
    CommandState.FAILED: answer_t.FAILED,
    CommandState.EXPIRED: answer_t.EXPIRED,
}
"""States as they travel."""


class CommandError(Exception):
    """A command cannot be answered again, or be sent like that; says which, and why."""


class Source(Reads[T]):
    """The reader of one sender's commands, which wants bytes and no values."""

    def __init__(self, channel: str, message_type: type[T]) -> None:
        super().__init__(channel, message_type)
        self.arrived: list[bytes] = []

    def freeze(self, fresh: list[bytes]) -> None:
        """For the framework: begins an iteration."""
        super().freeze(fresh)
        self.arrived = fresh

    @property
    def sender(self) -> str:
        """The component whose commands come here."""
        return self.channel.partition("@")[2]


class Command(Generic[T]):
    """One command: `value` says what is wanted, `accept`, `reject`, `done` and `fail` tell its sender.

    It may be answered in a later iteration than the one that got it. Of these answers all but `accept` are the last.
    """

    def __init__(self, queue: "Queue[Any]", source: Source[T], header: Header, data: bytes) -> None:
        self.state = CommandState.SENT
        self.sender = source.sender
        self.sequence = header.sequence
        """With the sender's name it is unlike every other command of the run."""
        self.sent_us = header.time_us
        self.value: T = cast(T, messages.decode(cast(Any, source.message_type), data, source.channel))
        self._queue = queue

    @property
    def expires_us(self) -> int:
        """Logical time after which it shall not be begun; 0: never."""
        return int(cast(Any, self.value).command.expires_us)

    @property
    def finished(self) -> bool:
        """Whether the last answer was given."""
        return self.state not in (CommandState.SENT, CommandState.ACCEPTED)

    def accept(self) -> None:
        """It is being carried out; tells the sender that it takes longer than this iteration."""
        self._answer(CommandState.ACCEPTED)

    def done(self) -> None:
        """It was carried out."""
        self._answer(CommandState.DONE)

    def reject(self, reason: str) -> None:
        """It is not going to be carried out."""
        self._answer(CommandState.REJECTED, reason)

    def fail(self, reason: str) -> None:
        """It was begun and could not be carried out."""
        self._answer(CommandState.FAILED, reason)

    def expire(self) -> None:
        """For the framework: it has waited for too long."""
        self._answer(CommandState.EXPIRED, "it was not begun in time")

    def _answer(self, state: CommandState, reason: str = "") -> None:
        if self.finished or state == self.state:
            raise CommandError(
                f"{self._queue.name}: command {self.sequence} of {self.sender} is {self.state} already "
                f"and cannot be {state}"
            )
        self.state = state
        self._queue.answer(self._message(), WIRE[state], self.sender, self.sequence, reason)
        if self.finished:
            self._queue.finish(self)

    def _message(self) -> Any:
        """What the answer travels in."""
        return self._queue.empty()


C = TypeVar("C", bound=Command[Any])


class Queue(ABC, Generic[C]):
    """What `Commands` and `Serves` have in common. Iterating over it takes out the commands, each of them once.

    They come in the order of the contract: tick, stage, sender, sequence. What is not taken out stays for the next
    iteration. An owner that was started again is not given what was sent before: its predecessor may have begun it.
    """

    def __init__(self, name: str, owner: str, clock: Clock, sources: Mapping[str, Any], answers: Writes[Any]) -> None:
        self.name = name
        self.expired = 0  # commands that were not begun in their time
        self.refused = 0  # commands that found the queue full
        self.open: list[C] = []
        """Commands that were taken out and are not finished, the oldest first."""
        self._owner = owner
        self._clock = clock
        self._sources: list[Source[Any]] = [sources[channel] for channel in sorted(sources)]
        self._answers = answers
        self._waiting: deque[C] = deque()
        self._unfinished = dict.fromkeys((source.sender for source in self._sources), 0)
        self._newest = dict.fromkeys(self._unfinished, 0)  # sequence number of each sender's newest command
        self._fresh_start = True

    def __iter__(self) -> Iterator[C]:
        while command := self.take():
            yield command

    def take(self) -> C | None:
        """Takes out the next command; None when none waits."""
        if not self._waiting:
            return None
        self.open.append(self._waiting.popleft())
        return self.open[-1]

    def __len__(self) -> int:
        """Commands that wait to be taken out."""
        return len(self._waiting)

    def begin(self) -> None:
        """For the framework: takes in what the frozen inputs hold."""
        arrived = [(source, Header.of(data), data) for source in self._sources for data in source.arrived]
        if self._fresh_start:
            self._fresh_start = False
            if self._clock.tick > 1:
                self._forget()
                return
        if self._waiting:
            self._expire()
        for source, header, _ in arrived:
            self._miss(source, header.sequence)
        arrived.sort(key=lambda each: (each[1].tick, each[1].stage, each[0].sender, each[1].sequence))
        for source, header, data in arrived:
            self._take(source, header, data)

    def end(self) -> None:
        """For the framework: the owner was stopped; whatever it has not finished has failed."""
        waiting, self._waiting = self._waiting, deque()
        for command in [*self.open, *waiting]:
            command.fail(f"{self._owner} was stopped")

    def answer(self, message: Any, state: int, sender: str, sequence: int, reason: str) -> None:
        """For the framework: sends an answer at the end of the iteration."""
        said: answer_t = message.answer
        said.state, said.sender, said.sequence, said.reason = state, sender, sequence, reason
        self._answers.value = message
        self._answers.write()

    def empty(self) -> Any:
        """For the framework: an answer without content."""
        return self._answers.message_type()

    def finish(self, command: Command[Any]) -> None:
        """For the framework: the command needs no room any more."""
        self._unfinished[command.sender] -= 1
        self.open = [each for each in self.open if each is not command]

    @abstractmethod
    def _command(self, source: Source[Any], header: Header, data: bytes) -> C:
        """What has come, for the owner."""

    def _miss(self, source: Source[Any], sequence: int) -> None:
        """Tells the sender of what did not come: the owner was away for too long, or it was lost for good."""
        newest, self._newest[source.sender] = self._newest[source.sender], sequence
        for missing in range(max(newest + 1, sequence - QUEUE_MAX), sequence):
            reason = f"it did not reach {self._owner}"
            self.answer(self.empty(), answer_t.FAILED, source.sender, missing, reason)

    def _take(self, source: Source[Any], header: Header, data: bytes) -> None:
        if self._unfinished[source.sender] >= QUEUE_MAX:
            self.refused += 1
            reason = f"queue full: {QUEUE_MAX} commands of {source.sender} are not finished"
            self.answer(self.empty(), answer_t.REJECTED, source.sender, header.sequence, reason)
            return
        command = self._command(source, header, data)
        self._unfinished[source.sender] += 1
        if self._late(command):
            command.expire()
        else:
            self._waiting.append(command)

    def _late(self, command: C) -> bool:
        late = 0 < command.expires_us < self._clock.now_us
        self.expired += late
        return late

    def _expire(self) -> None:
        waiting, self._waiting = self._waiting, deque()
        for command in waiting:
            if self._late(command):
                command.expire()
            else:
                self._waiting.append(command)

    def _forget(self) -> None:
        """The newest of each sender stands for all before it."""
        for source in self._sources:
            if source.arrived:
                newest = self._newest[source.sender] = Header.of(source.arrived[-1]).sequence
                reason = f"{self._owner} was started after it had been sent"
                self.answer(self.empty(), answer_t.FORGOTTEN, source.sender, newest, reason)


class Commands(Queue[Command[T]], Generic[T]):
    """The commands of a component that carries them out.

    `for kick in self.kick: ...; kick.done()`
    """

    def _command(self, source: Source[Any], header: Header, data: bytes) -> Command[T]:
        return Command(self, source, header, data)
