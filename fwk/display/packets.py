"""The packets that a display receives from the gateway."""

import select
import socket
from collections.abc import Iterator

from fwk.display.keys import Keyboard

LOOK_S = 0.5
"""Interval at which the display asks which components a waiting run waits for."""
_PACKET_BYTES = 1 << 20


def packets(connection: socket.socket, idle_s: float, keyboard: Keyboard | None = None) -> Iterator[bytes]:
    """Yields packets as they come, and an empty one at a key or when nothing came for `idle_s`; ends with the
    connection.
    """
    while True:
        keys = keyboard.descriptors if keyboard else []
        ready, _, _ = select.select([connection.fileno(), *keys], [], [], idle_s)
        if connection.fileno() not in ready:
            yield b""
            continue
        try:
            packet = connection.recv(_PACKET_BYTES)
        except ConnectionError:
            return
        if not packet:
            return
        yield packet
