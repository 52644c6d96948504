"""Departure of a host from a run that goes on: supervisor and gateway first get everything that it has sent.

A component that failed takes its process with it, so its host leaves in the same way, but without a final done.
"""

from collections.abc import Callable, Sequence

from fwk.bus import sync
from fwk.bus.network import Network, Steps
from fwk.bus.retransmission import Backoff
from fwk.bus.sender import Sender
from fwk.model.ports import Ports
from lcmtypes.core import done_t, leaving_t, taken_t

REPEAT_US = 5_000
LONGEST_REPEAT_US = 200_000
"""All hosts of a run leave at once: supervisor and gateway may be busy with a hundred others."""
TIMEOUT_US = 500_000
"""In real time: a supervisor or gateway that has not answered by then has ended or stopped."""
LOCKSTEP_TIMEOUT_US = 2_500_000
"""In lockstep, where time is not short; less than the time that hosts have when the whole run ends."""

REPETITIONS_LEAST = 7
"""Repetitions without an answer before the host leaves: a machine that was suspended has let no time for answers."""


class Shutdown:
    """Repeats the last messages of a leaving host until the supervisor and the gateway have taken them.

    No process can be asked again once it has ended. Supervisor and gateway answer with a `taken_t`, each with its own
    number.

    Args:
        network: the host's network.
        ports: ports of the run.
        sender: the host's sender.
        leaving: names the newest message of each channel that the host has sent; the gateway takes it once it holds
        all of them.
        dones: those of the newest tick and the final one, for the supervisor; empty: the host has failed.
        timeout_us: wall time after which the host leaves without an answer.
    """

    def __init__(
        self,
        network: Network,
        ports: Ports,
        sender: Sender,
        leaving: leaving_t,
        dones: Sequence[bytes],
        timeout_us: int,
    ) -> None:
        self._network = network
        self._ports = ports
        self._sender = sender
        self._dones = dones
        self._incarnation = leaving.incarnation
        self._leaving = leaving.encode()
        self._timeout_us = timeout_us
        self._unanswered = {ports.gateway, taken_t.SUPERVISOR} if dones else {ports.gateway}

    def answered(self, taken: taken_t) -> None:
        """Takes an answer; one to an earlier incarnation does not count."""
        if taken.kind == done_t.FINAL and taken.incarnation == self._incarnation:
            self._unanswered.discard(taken.taker)

    def wait(self, handle_own: Callable[[], object]) -> Steps[None]:
        """Waits for all answers; `handle_own` answers fetches during the wait."""
        network = self._network
        end_us = network.now_us() + self._timeout_us
        repetition = Backoff(network.now_us(), 0, LONGEST_REPEAT_US, REPEAT_US)
        sent = 0
        while self._unanswered and ((now_us := network.now_us()) < end_us or sent <= REPETITIONS_LEAST):
            if now_us >= repetition.due_us:
                self._send()
                repetition.repeated(now_us)
                sent += 1
            yield min(repetition.due_us, max(end_us, now_us + REPEAT_US), self._sender.due_us)
            self._sender.send_due()
            handle_own()

    def _send(self) -> None:
        gateway = self._ports.gateway
        if gateway in self._unanswered:
            self._sender.send(sync.LEAVING, self._leaving, self._ports.host(gateway))
        if taken_t.SUPERVISOR in self._unanswered:
            for done in self._dones:  # the supervisor takes dones in their order
                self._sender.publish(sync.DONE, done, self._ports.sync)
