"""Answers fetches in place of writers that have left the run, from the messages of the newest ticks."""

from collections.abc import Callable

from fwk.bus.sender import Sender
from fwk.engine.catch_up import AWAY_TICKS
from fwk.engine.message_history import gaps
from fwk.gateway.ingress import Ingress
from fwk.host.inputs import Inputs
from fwk.lcm.messages import Header
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from lcmtypes.core import fetch_t, gone_t


class FetchServer:
    """Keeps messages that readers may still lack, and answers their fetches.

    It keeps the newest message of each channel, all messages of the last two recorded ticks (in real time: 17), which
    is the largest delay of a reader that takes part, and all later ones. Its answer is final: the tick that the
    reader takes part in, and with it the next record, may be waiting for it.
    """

    def __init__(
        self, plan: Plan, inputs: Inputs, ingress: Ingress, sender: Sender, give_up: Callable[[gone_t], None]
    ) -> None:
        self._kept_ticks = AWAY_TICKS if plan.clock == "wall" else 1
        self._recent: dict[int, list[tuple[int, int, bytes]]] = {}  # by channel: tick, sequence number, message
        self._ports = Ports.of(plan)
        self._inputs = inputs
        self._ingress = ingress
        self._sender = sender
        self._give_up = give_up

    def keep(self, channel: int, tick: int, arrived: list[tuple[Header, bytes]]) -> None:
        """Keeps the messages of a channel that became visible in a tick."""
        recent = [each for each in self._recent.get(channel, []) if each[0] >= tick - self._kept_ticks]
        recent += [(header.tick, header.sequence, data) for header, data in arrived]
        self._recent[channel] = recent

    def answer(self, fetch: fetch_t) -> None:
        """Sends the fetched messages, or answers that they are gone."""
        if fetch.channel not in self._inputs:
            return
        buffer, first, last = self._inputs.buffer(fetch.channel), fetch.first_sequence, fetch.last_sequence
        found = self._ingress.kept(fetch.channel, first, last)
        if found is None:
            recent = self._recent.get(fetch.channel, [])
            found = [(number, data) for _, number, data in recent if first <= number <= last]
            found += buffer.held(first, last)
        for missing_first, missing_last in gaps((number for number, _ in found), first, last):
            self._answer_gone(fetch, missing_first, missing_last)
        for _, data in found if fetch.host != self._ports.gateway else ():
            self._sender.publish_paced(buffer.plan.name.encode(), data, self._ports.channel(fetch.channel))

    def _answer_gone(self, fetch: fetch_t, first: int, last: int) -> None:
        gone = gone_t()
        gone.run, gone.channel, gone.first_sequence, gone.last_sequence = fetch.run, fetch.channel, first, last
        if fetch.host == self._ports.gateway:
            self._give_up(gone)
        else:
            self._sender.send(b"fwk/gone", gone.encode(), self._ports.host(fetch.host))
