"""Passes lines of text to components with the aspect `LogLines`."""

from collections.abc import Callable
from typing import Any

from fwk.clock import US_PER_S, monotonic_us
from fwk.component.log import Logger
from fwk.gateway.ingress import IngressFullError
from fwk.lcm.messages import MessageError, decoder
from fwk.model.names import LINES
from lcmtypes.core import log_t

_decode = decoder(log_t, "fwk/log")


class LogTarget:
    """Sink that makes lines messages from outside: stamped, visible from the next tick on, recorded."""

    def __init__(self, take_in: Callable[[str, Any], int], log: Logger) -> None:
        self._take_in = take_in
        self._log = log
        self._dropped = 0
        self._say_us = 0

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Takes a line; ignores all other messages."""
        if channel != "fwk/log":
            return
        try:
            self._take_in(LINES, _decode(data))
        except IngressFullError:
            self._dropped += 1
        except MessageError:  # it does not decode; the other targets name it
            return

    def tick(self) -> None:
        """Reports dropped lines, at most once a second: after a tick there is room for the report."""
        now_us = monotonic_us()
        if self._dropped and now_us >= self._say_us:
            dropped, self._dropped, self._say_us = self._dropped, 0, now_us + US_PER_S
            self._log.warning(f"{dropped} lines did not reach the components with LogLines: too many in one tick")

    def close(self) -> None:
        """Does nothing."""
