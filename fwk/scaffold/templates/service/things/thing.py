"""Offers a service to other components."""

import math

from fwk import Component, Config, Logger, Serves
from lcmtypes.thing import thing_reply_t, thing_request_t


class ThingConfig(Config):
    """Settings of the component."""

    largest: float = 1000.0
    """Requests with a larger sum are rejected."""


class Thing(Component):
    """Adds up the numbers of a request and replies with the sum."""

    stage = "think"

    config: ThingConfig
    log: Logger
    thing: Serves[thing_request_t, thing_reply_t]

    def loop(self) -> None:
        for request in self.thing:
            total = request.value.a + request.value.b
            if math.isfinite(total) and abs(total) <= self.config.largest:
                request.reply.sum = total
                request.done()
            else:
                request.reject(f"a sum of {total:g} is too large")
                self.log.warning(f"rejected a request of {request.sender}")
