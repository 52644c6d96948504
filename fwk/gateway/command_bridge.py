"""Commands from tools: taken in for who asks at the control socket, and answered as their owner answers."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from fwk.clock import US_PER_S, Clock
from fwk.component.calls import state_of
from fwk.component.services import ANSWERS, QUEUE_MAX, RequestState
from fwk.control.requests import Call, RequestError
from fwk.control.server import Connection
from fwk.gateway.ingress import WRITER, Full
from fwk.lcm import messages
from fwk.lcm.messages import MessageError
from fwk.model.errors import hint
from fwk.model.plan import Plan
from fwk.plan.wiring.command_wiring import OUTSIDE
from lcmtypes.core import answer_t


@dataclass
class _Owner:
    """Whoever carries out the commands of a name, and who waits for an answer."""

    message_type: Any
    reply_type: Any
    waiting: dict[int, Connection] = field(default_factory=dict)


class Calls:
    """A sink of the gateway that hears the answers; `take_in` makes a message one of the run."""

    def __init__(self, plan: Plan, take_in: Callable[[str, Any], int], clock: Clock) -> None:
        types = {channel.name: channel.type_name for channel in plan.channels}
        self._owners = {
            target: _Owner(messages.type_named(types[channel]), messages.type_named(types[f"{target}@{ANSWERS}"]))
            for channel in types
            for target, _, sender in (channel.partition("@"),)
            if sender == OUTSIDE
        }
        self._take_in = take_in
        self._clock = clock

    def call(self, request: Call, connection: Connection) -> None:
        """Sends a command into the run; answers go to the connection as they come.

        Raises:
            RequestError: it cannot be sent.
        """
        owner = self._owners.get(request.name)
        if owner is None:
            raise RequestError(f"nobody carries out '{request.name}'; {hint(request.name, self._owners)}")
        owner.waiting = {number: each for number, each in owner.waiting.items() if each.open}
        if len(owner.waiting) >= QUEUE_MAX:
            raise RequestError(f"queue full: {QUEUE_MAX} commands to {request.name} are not finished")
        try:
            message = messages.decode(owner.message_type, bytes.fromhex(request.data), request.name)
            message.command.expires_us = self._clock.now_us + round(request.expires_s * US_PER_S)
            sequence = self._take_in(f"{request.name}@{OUTSIDE}", message)
        except (MessageError, Full, ValueError) as error:
            raise RequestError(str(error)) from error
        owner.waiting[sequence] = connection
        connection.reply({"ok": True, "name": request.name, "sequence": sequence, "state": RequestState.SENT})

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message; answers to tools are passed on."""
        target, _, what = channel.partition("@")
        owner = self._owners.get(target)
        if what != ANSWERS or owner is None or not owner.waiting:
            return
        message = messages.decode(owner.reply_type, data, channel)
        answer: answer_t = message.answer
        if answer.sender != WRITER:
            return
        meant = [answer.sequence]
        if answer.state == answer_t.FORGOTTEN:
            meant = [number for number in owner.waiting if number <= answer.sequence]
        for number in meant:
            self._tell(owner, target, number, message)

    def tick(self) -> None:
        """Nothing to do."""

    def close(self) -> None:
        """Nothing to do; the control server leaves everybody."""

    def _tell(self, owner: _Owner, target: str, number: int, message: Any) -> None:
        connection = owner.waiting.get(number)
        if connection is None:
            return
        state = state_of(message.answer)
        if state is not RequestState.ACCEPTED:
            del owner.waiting[number]
        told = {"name": target, "sequence": number, "state": state, "reason": message.answer.reason}
        value = messages.to_dict(message)
        reply = {key: below for key, below in value.items() if key not in ("header", "answer")}
        connection.reply({"ok": True, **told, "tick": message.header.tick, "reply": reply})
