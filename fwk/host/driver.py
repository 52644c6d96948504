"""Runs a host on the machine's sockets and clock."""

import socket
from collections.abc import Callable, Mapping

from fwk.bus.network import UdpNetwork
from fwk.engine.assignment import Assignment
from fwk.engine.runner import Runner
from fwk.host.background_server import BackgroundServer
from fwk.host.continuous import host_of
from fwk.host.hooks import ProcessHooks
from fwk.host.process import StopSignal, give_memory_back, lift_limit


class HostDriver:
    """A host in a process of its own."""

    def __init__(
        self,
        assignment: Assignment,
        stop: StopSignal,
        make_runner: Callable[..., Runner] = Runner,
        held: Mapping[int, socket.socket] | None = None,
    ) -> None:
        self._network = UdpNetwork(held)
        self._network.watch_wakeup(stop.wakeup)
        hooks = ProcessHooks(
            stopping=stop,
            make_runner=make_runner,
            background=BackgroundServer().serving,
            initialized=give_memory_back,
            runs_ahead=True,
            lift_memory_limit=lift_limit,
        )
        self.host = host_of(assignment, self._network, hooks)

    def serve(self) -> None:
        """Takes the host's components from `init` to `finalize`.

        Raises:
            ComponentFailedError: a component raised.
        """
        self._network.run(self.host.serve())
