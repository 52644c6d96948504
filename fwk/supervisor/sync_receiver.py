"""Receives the reports of hosts and gateway to the supervisor: dones and states."""

import struct
from collections.abc import Callable

from fwk.bus import sync
from fwk.bus.sockets import LOOPBACK, Address, told
from fwk.lcm import wire
from fwk.lcm.messages import MessageError
from fwk.model.ports import Ports
from fwk.supervisor.event_loop import EventLoop
from lcmtypes.core import actual_t, done_t


class SyncReceiver:
    """The supervisor's socket for dones and states; refuses, counts and names foreign messages."""

    def __init__(self, events: EventLoop, ports: Ports, run: int, complain: Callable[[str, str], None]) -> None:
        self._emit = events.emit
        self._first_host, self._gateway_port = ports.host(0), ports.host(ports.gateway)
        self._members = ports.members
        self._assembler = wire.Assembler()
        self._run = run
        self._complain = complain
        self._socket = events.network.group_socket(ports.sync)
        events.watch(self._socket, self.drain)

    def drain(self) -> None:
        """Emits the dones and states that have arrived as events."""
        receive = self._socket.recvfrom
        while True:
            try:
                datagram, address = receive(wire.DATAGRAM_MAX)
            except BlockingIOError:
                return
            try:
                self._dispatch(datagram, address)
            except (MessageError, ValueError, struct.error) as error:
                self._complain("fwk/sync", f"{error}; refused")

    def _dispatch(self, datagram: bytes, address: Address) -> None:
        host, source = address
        if source not in self._members or host != LOOPBACK:
            raise MessageError(f"datagram from {told(address)}, which is not of this run")
        if datagram.startswith(sync.DONE_START, 8) and wire.is_short(datagram):
            self._take_done(datagram[8 + len(sync.DONE_START) :], source)
            return
        channel, data = self._assembler.feed(datagram, source) or (b"", b"")
        if channel == sync.DONE:
            self._take_done(data, source)
        elif channel == sync.RECORDED:
            recorded = sync.decode_recorded(data)
            if source != self._gateway_port:
                raise MessageError(f"datagram from port {source}, which is not the gateway's")
            if recorded.run == self._run:
                self._emit(recorded)
        elif channel == sync.ACTUAL:
            self._take_state(sync.decode_actual(data), source)
        elif channel:
            raise MessageError(f"channel {channel!r} does not belong on the sync bus")

    def _take_done(self, data: bytes, source: int) -> None:
        done = sync.decode_done(data)
        self._check(done, source)
        if done.run == self._run:
            self._emit(done)

    def _take_state(self, actual: actual_t, source: int) -> None:
        self._check(actual, source)
        if len(actual.times) != len(actual.components):
            raise MessageError(f"state of host {actual.host} with other times than components")
        if actual.run == self._run:
            self._emit(actual)

    def _check(self, message: done_t | actual_t, source: int) -> None:
        if source - self._first_host != message.host or source == self._gateway_port:
            raise MessageError(f"datagram from port {source}, which is not host {message.host}'s")
