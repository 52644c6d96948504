"""Sends the requests and commands of tools into the run and returns the replies of the components that serve them."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from fwk.clock import US_PER_S, Clock
from fwk.component.calls import state_of
from fwk.component.services import QUEUE_MAX, RequestState
from fwk.control.requests import CallService, RequestError
from fwk.control.server import Connection
from fwk.gateway.ingress import WRITER, IngressFullError
from fwk.lcm import messages
from fwk.lcm.messages import MessageError
from fwk.model.errors import hint
from fwk.model.plan import Plan
from fwk.model.service_channels import ANSWERS, OUTSIDE, client_of, service_channel, service_of
from lcmtypes.core import answer_t


@dataclass
class _Service:
    """Service that one component offers under one name, with the tools that wait for its replies."""

    message_type: Any
    reply_type: Any
    waiting: dict[int, Connection] = field(default_factory=dict)


class CommandBridge:
    """A sink of the gateway that passes replies on to tools.

    Args:
        plan: the plan of the run.
        take_in: makes a message one of the run; returns its sequence number.
        clock: the newest tick, against which requests expire.
    """

    def __init__(self, plan: Plan, take_in: Callable[[str, Any], int], clock: Clock) -> None:
        types = {channel.name: channel.type_name for channel in plan.channels}
        self._services = {
            service_of(channel): _Service(
                messages.type_named(types[channel]),
                messages.type_named(types[service_channel(service_of(channel), ANSWERS)]),
            )
            for channel in types
            if client_of(channel) == OUTSIDE
        }
        self._take_in = take_in
        self._clock = clock

    def call(self, request: CallService, connection: Connection) -> None:
        """Sends a tool's request into the run; replies go to the connection as they come.

        Raises:
            RequestError: the request cannot be sent.
        """
        service = self._services.get(request.name)
        if service is None:
            raise RequestError(f"no component serves '{request.name}'; {hint(request.name, self._services)}")
        service.waiting = {number: each for number, each in service.waiting.items() if each.open}
        if len(service.waiting) >= QUEUE_MAX:
            raise RequestError(f"queue full: {QUEUE_MAX} commands to {request.name} are not finished")
        try:
            message = messages.decode(service.message_type, bytes.fromhex(request.data), request.name)
            message.command.expires_us = self._clock.now_us + round(request.expires_s * US_PER_S)
            sequence = self._take_in(service_channel(request.name, OUTSIDE), message)
        except (MessageError, IngressFullError, ValueError) as error:
            raise RequestError(str(error)) from error
        service.waiting[sequence] = connection
        connection.reply({"ok": True, "name": request.name, "sequence": sequence, "state": RequestState.SENT})

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a message of the run; passes it on if it is a reply to a tool."""
        if client_of(channel) != ANSWERS:
            return
        target = service_of(channel)
        service = self._services.get(target)
        if service is None or not service.waiting:
            return
        message = messages.decode(service.reply_type, data, channel)
        answer: answer_t = message.answer
        if answer.sender != WRITER:
            return
        meant = [answer.sequence]
        if answer.state == answer_t.FORGOTTEN:
            meant = [number for number in service.waiting if number <= answer.sequence]
        for number in meant:
            self._reply(service, target, number, message)

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Does nothing: the channel server disconnects the tools."""

    def _reply(self, service: _Service, target: str, number: int, message: Any) -> None:
        connection = service.waiting.get(number)
        if connection is None:
            return
        state = state_of(message.answer)
        if state is not RequestState.ACCEPTED:
            del service.waiting[number]
        told = {"name": target, "sequence": number, "state": state, "reason": message.answer.reason}
        value = messages.to_dict(message)
        reply = {key: below for key, below in value.items() if key not in ("header", "answer")}
        connection.reply({"ok": True, **told, "tick": message.header.tick, "reply": reply})
