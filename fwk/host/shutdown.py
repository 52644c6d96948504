"""How a host leaves a run that goes on: not before supervisor and gateway have all that it has sent."""

from collections.abc import Callable, Mapping

from fwk.bus import sync
from fwk.bus.sockets import Sender
from fwk.clock import monotonic_us
from fwk.model.ports import Ports
from lcmtypes.core import done_t

REPEAT_US = 5_000
PATIENCE_US = 500_000  # a supervisor or gateway that has not answered by then has ended, or will not any more


class Leaving:
    """Repeats the last dones until the supervisor has taken the final one and the gateway holds every message.

    When the process has ended nobody can ask it again. Both send the final done back, each with its own number as host.
    """

    def __init__(self, ports: Ports, sender: Sender, before: bytes, final: done_t, sent: Mapping[int, int]) -> None:
        self._ports = ports
        self._sender = sender
        self._before = before
        self._final = sync.encode_done(final)
        everything = done_t()
        everything.run, everything.host, everything.incarnation = final.run, final.host, final.incarnation
        everything.tick, everything.stage, everything.next_time_us = final.tick, done_t.FINAL, -1
        everything.n_marks, everything.channel, everything.sequence = len(sent), list(sent), list(sent.values())
        self._everything = sync.encode_done(everything)
        self._waits_for = {final.host, ports.gateway}

    def heard(self, done: done_t) -> None:
        """One of the two has what it needs."""
        if done.stage == done_t.FINAL:
            self._waits_for.discard(done.host)

    def wait(self, handle_own: Callable[[], object]) -> None:
        """Until both have; meanwhile `handle_own` answers who lacks something."""
        end_us = monotonic_us() + PATIENCE_US
        repeat_us = 0
        while self._waits_for and (now_us := monotonic_us()) < end_us:
            if now_us >= repeat_us:
                self._send()
                repeat_us = now_us + REPEAT_US
            self._sender.wait(REPEAT_US)
            handle_own()

    def _send(self) -> None:
        if self._ports.gateway in self._waits_for:
            self._sender.send(sync.DONE, self._everything, self._ports.host(self._ports.gateway))
        if len(self._waits_for) > 1 or self._ports.gateway not in self._waits_for:
            if self._before:  # the supervisor takes them in their order
                self._sender.publish(sync.DONE, self._before, self._ports.sync)
            self._sender.publish(sync.DONE, self._final, self._ports.sync)
