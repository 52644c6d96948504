"""How a host leaves a run that goes on: not before supervisor and gateway have everything that it has sent."""

from collections.abc import Callable, Mapping

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.sender import Sender
from fwk.model.ports import Ports
from lcmtypes.core import done_t

REPEAT_US = 5_000
TIMEOUT_US = 500_000
"""A supervisor or gateway that has not answered by then has ended, or will not answer any more."""


class Shutdown:
    """Repeats the last dones until the supervisor has taken the final one and the gateway holds every message.

    No process can be asked again once it has ended. Supervisor and gateway send the final done back, each with its own
    number as host.
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
        everything = done_t()
        everything.run, everything.host, everything.incarnation = final.run, final.host, final.incarnation
        everything.tick, everything.stage, everything.next_time_us = final.tick, done_t.FINAL, -1
        everything.n_marks, everything.channel, everything.sequence = len(sent), list(sent), list(sent.values())
        self._everything = sync.encode_done(everything)
        self._unanswered = {final.host, ports.gateway}

    def answered(self, done: done_t) -> None:
        """Takes a final done that supervisor or gateway sent back."""
        if done.stage == done_t.FINAL:
            self._unanswered.discard(done.host)

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
            self._sender.send(sync.DONE, self._everything, self._ports.host(gateway))
        if self._unanswered - {gateway}:
            if self._before:  # the supervisor takes dones in their order
                self._sender.publish(sync.DONE, self._before, self._ports.sync)
            self._sender.publish(sync.DONE, self._final, self._ports.sync)
