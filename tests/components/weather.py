"""Makes the processes that import it lose datagrams at the sender and use small buffers."""

import os
import random
import socket
from typing import Any

from fwk.bus import network, sockets

loss = float(os.environ.get("FWK_TEST_LOSS", "0"))
buffer_bytes = int(os.environ.get("FWK_TEST_BUFFER_BYTES", "0"))

if loss:

    class _Lossy:
        def __init__(self, real: socket.socket) -> None:
            self._real = real
            self._luck = random.Random(real.getsockname()[1])

        def sendto(self, datagram: bytes, address: tuple[str, int]) -> None:
            if self._luck.random() >= loss:
                self._real.sendto(datagram, address)

        def __getattr__(self, name: str) -> Any:
            return getattr(self._real, name)

    _calm = network.UdpNetwork.own_socket

    def _own_socket(self: network.UdpNetwork, port: int) -> Any:
        return _Lossy(_calm(self, port))  # type: ignore[arg-type]

    network.UdpNetwork.own_socket = _own_socket  # type: ignore[method-assign]

if buffer_bytes:
    sockets.multicast_receiver.__defaults__ = (buffer_bytes,)
