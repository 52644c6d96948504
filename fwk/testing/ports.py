"""The other side of a component's ports on the bench: input of a test, and messages that were sent."""

from typing import Any, cast

from fwk.clock import US_PER_S
from fwk.lcm import envelope, messages
from lcmtypes.core import answer_t, command_t, header_t


class PortBench:
    """Other side of one port: `put` makes messages visible, `sent` has what the component sent."""

    def __init__(self, channel: str, message_type: type[messages.Message]) -> None:
        self.channel = channel
        self.message_type = message_type
        self.waiting: list[bytes] = []
        self.sent: list[Any] = []
        self._sequence = 0
        self._stamp = envelope.stamper(message_type, channel)

    def put(self, message: Any = None, header: Any = None, **fields: Any) -> None:
        """Makes a message visible to the next iteration: a whole one, or some fields of one that is otherwise zero.

        A nested struct may be given as a dict: `put(ball={"x_m": 1.0})`.

        The header, or the stamp of a type without one, is `header`, else that of the message; the number is set here.
        """
        made = cast(Any, message)
        if made is None:
            made = messages.of_dict(self.message_type, fields)
        else:
            plain = messages.of_dict(self.message_type, fields)
            for name in fields:
                setattr(made, name, getattr(plain, name))
        self._sequence += 1
        if isinstance(header, dict):
            header = header_t(**header)
        given = header or (made.header if messages.has_header(self.message_type) else header_t())
        numbers = given.tick, self._sequence, given.time_us, given.stage
        self.waiting.append(self._stamp(made, *numbers, given.writer))


class OtherSender(PortBench):
    """The sender of a component that carries out commands; `sent` are its answers."""

    def __init__(self, channel: str, message_type: type[messages.Message], answers: PortBench) -> None:
        super().__init__(channel, message_type)
        self.sent = answers.sent

    def put(self, message: Any = None, header: Any = None, expires_s: float | None = None, **fields: Any) -> None:
        """Sends a command, which must not begin after `expires_s` of logical time on the bench's clock."""
        if expires_s is not None:
            fields["command"] = command_t()
            fields["command"].expires_us = round(expires_s * US_PER_S)
        super().put(message, header, **fields)


class OtherOwner(PortBench):
    """The owner of commands that a component sends; `sent` are the commands."""

    def __init__(self, channel: str, message_type: type[messages.Message], answers: PortBench, sender: str) -> None:
        super().__init__(channel, message_type)
        self._answers = answers
        self._sender = sender

    def answer(self, state: int = answer_t.DONE, reason: str = "", sequence: int = 0, **fields: Any) -> None:
        """Answers the newest command, or the one with that number; `fields` are those of a reply."""
        answer = answer_t()
        answer.state, answer.reason, answer.sender = state, reason, self._sender
        answer.sequence = sequence or self.sent[-1].header.sequence
        self._answers.put(answer=answer, **fields)
