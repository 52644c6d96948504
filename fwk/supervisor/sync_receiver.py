"""Everything that reaches the supervisor from outside its own thread of work, handed out as events."""

import os
import signal
import struct
from collections.abc import Callable

from fwk.bus import sync
from fwk.bus.sockets import Address, multicast_receiver, port_of, told
from fwk.bus.waiting import Waiting
from fwk.clock import US_PER_S, sleep_s
from fwk.lcm import wire
from fwk.lcm.messages import MessageError
from fwk.model.ports import Ports
from lcmtypes.core import actual_t, done_t

_COARSE_US = 1500  # poll counts in whole milliseconds

Handler = Callable[[], None]


class Mailbox:
    """The supervisor's sockets. `pump` waits for something and lets the handlers deal with it."""

    def __init__(self, ports: Ports, run: int, complain: Callable[[str, str], None]) -> None:
        self.on_done: Callable[[done_t], None] = lambda _: None
        self.on_actual: Callable[[actual_t], None] = lambda _: None
        self.afterwards: Handler = lambda: None  # called when something was handled
        self.signals: list[int] = []
        self._first_host = ports.host(0)
        self._members = ports.members
        self._assembler = wire.Assembler()
        self._run = run
        self._complain = complain
        self._socket = multicast_receiver(ports.sync)
        self._waiting = Waiting()
        self._handlers: dict[int, Handler] = {}
        self._wakeup, write = os.pipe()
        os.set_blocking(self._wakeup, False)
        os.set_blocking(write, False)
        signal.set_wakeup_fd(write, warn_on_full_buffer=False)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, lambda received, _frame: self.signals.append(received))
        self.watch(self._socket.fileno(), self.drain)
        self.watch(self._wakeup, self._drain_wakeup)

    def watch(self, descriptor: int, handler: Handler) -> None:
        """Calls `handler` from `pump` when there is something to read."""
        self._handlers[descriptor] = handler
        self._waiting.add(descriptor)

    def unwatch(self, descriptor: int) -> None:
        """No longer."""
        if self._handlers.pop(descriptor, None):
            self._waiting.remove(descriptor)

    def pump(self, timeout_us: int) -> None:
        """Handles what is there; if nothing is, waits for the first thing or `timeout_us`."""
        for descriptor in self._waiting.wait(timeout_us):
            handler = self._handlers.get(descriptor)
            if handler:
                handler()
        self.afterwards()

    def pump_until(self, left_us: int) -> None:
        """As `pump`, but never longer than `left_us`, to the microsecond as well as the system can."""
        if left_us > _COARSE_US:
            self.pump(left_us - _COARSE_US)
        else:
            sleep_s(left_us / US_PER_S)

    def _drain_wakeup(self) -> None:
        os.read(self._wakeup, 1024)

    def drain(self) -> None:
        """Handles the dones and states that have arrived."""
        while True:
            try:
                datagram, address = self._socket.recvfrom(wire.DATAGRAM_MAX)
            except BlockingIOError:
                return
            try:
                self._dispatch(datagram, address)
            except (MessageError, ValueError, struct.error) as error:
                self._complain("fwk/sync", f"{error}; refused")

    def _dispatch(self, datagram: bytes, address: Address) -> None:
        source = port_of(address)
        if source not in self._members:
            raise MessageError(f"datagram from {told(address)}, which is not of this run")
        if datagram.startswith(sync.DONE_START, 8) and wire.is_short(datagram):
            self._take_done(datagram[8 + len(sync.DONE_START) :], source)
            return
        channel, data = self._assembler.feed(datagram, source) or (b"", b"")
        if channel == sync.DONE:
            self._take_done(data, source)
        elif channel == b"fwk/actual":
            actual = actual_t.decode(data)
            self._check(actual, source)
            if actual.run == self._run:
                self.on_actual(actual)
        elif channel:
            raise MessageError(f"channel {channel!r} does not belong on the sync bus")

    def _take_done(self, data: bytes, source: int) -> None:
        done = sync.decode_done(data)
        self._check(done, source)
        if done.run == self._run:
            self.on_done(done)

    def _check(self, message: done_t | actual_t, source: int) -> None:
        if source - self._first_host != message.host:
            raise MessageError(f"datagram from port {source}, which is not host {message.host}'s")
