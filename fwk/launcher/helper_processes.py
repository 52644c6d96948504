"""The helper processes of a run beside the zygote: gateway, display and file watcher."""

import os
import signal
import socket
from collections.abc import Mapping
from functools import partial

from fwk.component.images import Ring
from fwk.control.watcher import Watcher
from fwk.display.display import run_display
from fwk.gateway.gateway import FINISHING
from fwk.host.process import ENDED_WELL, StopSignal, die_with_parent, end_child, name_process, run_forked, wait_for_end
from fwk.launcher.gateway_process import DELETED, UNWRITTEN, run_gateway
from fwk.launcher.reservations import Reservations
from fwk.model.plan import Plan
from fwk.recording import sinks
from fwk.supervisor.options import RunOptions

_PACKET_MAX = 1 << 20
_PATIENCE_S = 5.0


class HelperProcesses:
    """Forks gateway, display and watcher before the supervisor has sockets of its own.

    Gateway and display end when their connections are closed, and so when the supervisor dies; its death also wakes
    them if they were stopped.
    """

    def __init__(
        self, plan: Plan, run: int, options: RunOptions, rings: Mapping[str, Ring], reservations: Reservations
    ) -> None:
        self.gave_up = ""
        """Process that did not end in time, and the consequence; empty: all did."""
        self.lost = 0
        """Messages that the gateway never got; known after the end."""
        self.deleted = ""
        """File of the run that was deleted during the run; empty: none; known after the end."""
        self.unwritten = ""
        """Losses of the recording, as text; empty: none; known after the end."""
        self.control, gateway_control = _pair()
        display_feed, display_end = _pair()
        parent = os.getpid()
        self._display = os.fork()
        if self._display == 0:
            self.control.close()
            gateway_control.close()
            display_feed.close()
            reservations.release()
            die_with_parent(parent, signal.SIGCONT)
            name_process(plan.name, "display")
            run_forked(lambda _: _display(plan, display_end, options.plain))
        display_end.close()
        self._gateway = os.fork()
        if self._gateway == 0:
            self.control.close()
            os.setsid()
            die_with_parent(parent, signal.SIGCONT)
            name_process(plan.name, "gateway")
            run_forked(lambda _: run_gateway(plan, run, options, gateway_control, display_feed, rings, reservations))
        gateway_control.close()
        display_feed.close()
        self._watcher = os.fork() if options.watch else 0
        if options.watch and self._watcher == 0:
            self.control.close()
            reservations.release()
            os.setsid()
            die_with_parent(parent)
            name_process(plan.name, "watcher")
            run_forked(partial(_watch, plan))

    def fileno(self) -> int:
        """Returns the descriptor that is readable when the gateway has ended."""
        return self.control.fileno()

    def gateway_end(self) -> str:
        """Returns how the gateway ended, when it closed its end of `control` first."""
        pid, self._gateway = self._gateway, 0
        return wait_for_end(pid)

    def stop(self) -> dict[str, bytes]:
        """Lets gateway and display finish; returns the newest message of each channel."""
        if self._watcher:
            os.kill(self._watcher, signal.SIGTERM)
            end_child(self._watcher, 1.0)
        self.control.settimeout(_PATIENCE_S)
        newest: dict[str, bytes] = {}
        for pid in filter(None, (self._gateway, self._display)):
            os.kill(pid, signal.SIGCONT)  # it may have been stopped
        try:
            self.control.shutdown(socket.SHUT_WR)
            while packet := self.control.recv(_PACKET_MAX):
                channel, _, data = packet.partition(b"\0")
                newest[channel.decode()] = data
        except OSError as error:
            if self._gateway:
                os.kill(self._gateway, signal.SIGKILL)
            if self._gateway and isinstance(error, TimeoutError):
                when = f"{_PATIENCE_S:g} s after the end"
                self.gave_up = f"the gateway was not done {when}; killed: the recording may lack its end"
        newest.pop(FINISHING.decode(), None)
        self.deleted = newest.pop(DELETED.decode(), b"").decode()
        self.unwritten = newest.pop(UNWRITTEN.decode(), b"").decode()
        self.lost = int(newest.pop(sinks.LOST, 0))
        if self._gateway:
            how = wait_for_end(self._gateway)
            if not self.gave_up and how != ENDED_WELL:
                self.gave_up = f"the gateway ended: {how}: the recording may lack its end"
        os.waitpid(self._display, 0)
        return newest


def _pair() -> tuple[socket.socket, socket.socket]:
    return socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)


def _watch(plan: Plan, stop: StopSignal) -> int:
    Watcher(plan).run(stop)
    return 0


def _display(plan: Plan, connection: socket.socket, plain: bool) -> int:
    run_display(plan, connection, plain)
    return 0
