"""Delays the opening of the gateway's sockets by half a second."""

from typing import Any

from fwk.clock import sleep_s
from fwk.gateway.gateway import Gateway

make = Gateway.__init__


def make_slowly(self: Gateway, *arguments: Any) -> None:
    sleep_s(0.5)
    make(self, *arguments)


Gateway.__init__ = make_slowly  # type: ignore[method-assign, assignment]
