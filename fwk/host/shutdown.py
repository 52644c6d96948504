"""How a host leaves a run that goes on: not before supervisor and gateway have everything that it has sent."""

from collections.abc import Callable, Mapping

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.sender import Sender
from fwk.model.ports import Ports
from lcmtypes.core import done_t, leaving_t, taken_t

REPEAT_US = 5_000
TIMEOUT_US = 500_000
"""A supervisor or gateway that has not answered by then has ended, or will not answer any more."""


class Shutdown:
    """Repeats the last dones until the supervisor has taken the final one and the gateway holds every message.

    No process can be asked again once it has ended. Supervisor and gateway answer with a `taken_t`, each with its own
    number.
    """

    def __init__(
        self,
        network: Network,
        ports: Ports,
        sender: Sender,
        before: bytes,
        final: done_t,
        sent: Mapping[int, int],
    ) -> None:
        self._network = network
        self._ports = ports
        self._sender = sender
        self._before = before
        self._final = sync.encode_done(final)
        everything = leaving_t()
        everything.run, everything.host, everything.incarnation = final.run, final.host, final.incarnation
        everything.tick, everything.n_marks = final.tick, len(sent)
        everything.channel, everything.sequence = list(sent), list(sent.values())
        self._everything = everything.encode()
        self._unanswered = {taken_t.SUPERVISOR, ports.gateway}

    def answered(self, taken: taken_t) -> None:
        """Takes an answer to the final done."""
        if taken.kind == done_t.FINAL:
            self._unanswered.discard(taken.taker)

    def wait(self, handle_own: Callable[[], object]) -> Steps[None]:
        """Waits until both have answered; meanwhile `handle_own` answers fetches."""
        network = self._network
        end_us = network.now_us() + TIMEOUT_US
        repeat_us = 0
        while self._unanswered and (now_us := network.now_us()) < end_us:
            if now_us >= repeat_us:
                self._send()
                repeat_us = now_us + REPEAT_US
            yield min(repeat_us, end_us, self._sender.due_us)
            self._sender.send_due()
            handle_own()

    def _send(self) -> None:
        gateway = self._ports.gateway
        if gateway in self._unanswered:
            self._sender.send(sync.LEAVING, self._everything, self._ports.host(gateway))
        if taken_t.SUPERVISOR in self._unanswered:
            if self._before:  # the supervisor takes dones in their order
                self._sender.publish(sync.DONE, self._before, self._ports.sync)
            self._sender.publish(sync.DONE, self._final, self._ports.sync)
