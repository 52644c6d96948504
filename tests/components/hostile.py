"""Sends broken and forged messages from the port of its own process, to all ports of its run."""

import os
import random
import socket
from typing import Any

from fwk import Component, Config
from fwk.bus import sync
from fwk.bus.sockets import GROUP, LOOPBACK, multicast_receiver
from fwk.lcm import wire
from fwk.lcm.messages import MessageError
from lcmtypes.core import actual_t, done_t, fetch_t, gone_t, leaving_t, log_t, recorded_t, status_t, tick_record_t

TYPES: dict[bytes, type] = {
    b"fwk/done": done_t,
    b"fwk/actual": actual_t,
    b"fwk/record": tick_record_t,
    b"fwk/recorded": recorded_t,
    b"fwk/fetch": fetch_t,
    b"fwk/gone": gone_t,
    b"fwk/log": log_t,
    b"fwk/status": status_t,
    b"fwk/leaving": leaving_t,
    b"c/imu": log_t,
}
LARGEST = {"int8_t": 127, "int16_t": 32767, "int32_t": (1 << 31) - 1, "int64_t": (1 << 63) - 1}
SENT = 40  # messages in an iteration


class HostileConfig(Config):
    base: int = 0
    """First port of the run."""
    end: int = 0
    """First port that the run does not use; 0: nothing is sent."""


class Hostile(Component):
    stage = "think"
    config: HostileConfig

    def init(self) -> None:
        self._luck = random.Random(5)
        self._ticks = multicast_receiver(self.config.base + 1 + 5) if self.config.end else None
        self._assembler = wire.Assembler()
        self._run = 0

    def loop(self) -> None:
        if self._ticks is None:
            return
        self._run = self._run or self._heard_run(self._ticks)
        own = own_socket()
        for number in range(SENT if self._run else 0):
            channel = self._luck.choice([*TYPES])
            message = self._spoilt(TYPES[channel]())
            for datagram in wire.datagrams(number, channel, message):
                for port in self._luck.sample(range(self.config.base, self.config.end), 4):
                    own.sendto(datagram, (GROUP, port))
                    own.sendto(datagram, (LOOPBACK, port))
        own.close()

    def _heard_run(self, ticks: socket.socket) -> int:
        try:
            datagram, address = ticks.recvfrom(wire.DATAGRAM_MAX)
            _, data = self._assembler.feed(datagram, address[1]) or (b"", b"")
            run: int = sync.decode_tick(data).run
            return run
        except (BlockingIOError, MessageError):
            return 0

    def _spoilt(self, message: Any) -> bytes:
        lengths = {name for dimensions in message.__dimensions__ for name in dimensions or ()}
        for name, kind in zip(message.__slots__, message.__typenames__, strict=True):
            if kind in LARGEST and name not in lengths and isinstance(getattr(message, name), int):
                setattr(message, name, self._luck.choice([0, 1, 2, 5, -1, 100, LARGEST[kind]]))
        if hasattr(message, "run"):
            message.run = self._run
        data = bytearray(message.encode())
        if self._luck.random() < 0.5:
            data[self._luck.randrange(len(data))] ^= 1 << self._luck.randrange(8)
        return bytes(data[: self._luck.choice([len(data)] * 3 + [self._luck.randrange(len(data))])])


def own_socket() -> socket.socket:
    """Returns a copy of the socket from which this process sends."""
    for number in os.listdir("/proc/self/fd"):
        try:
            found = socket.socket(fileno=os.dup(int(number)))
        except OSError:
            continue
        if found.family == socket.AF_INET and found.getsockname()[0] == LOOPBACK:
            return found
        found.close()
    raise AssertionError("this process has no socket of its own")
