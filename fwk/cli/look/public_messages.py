"""The messages on the public bus of a run, for commands that watch them."""

import select
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NamedTuple

from fwk.bus.public import PublicBus
from fwk.cli.recordings.user_folders import use_folders
from fwk.cli.run_options import asking
from fwk.clock import US_PER_S, monotonic_us
from fwk.control import runs
from fwk.control.client import Client, ControlError
from fwk.lcm.messages import MessageError
from fwk.lcm.type_registry import header_of

_LOOK_US = US_PER_S


class Heard(NamedTuple):
    """A message on the public bus."""

    channel: str
    data: bytes
    time_us: int
    """Logical time of the message; 0: it has no header."""


@contextmanager
def listening(chosen: str | None, instead: str) -> Iterator[tuple[dict[str, Any], Iterator[Heard]]]:
    """Opens the public bus of a run: yields facts about the run, and its messages from now on until it ends.

    Ends the command if no run answers, or the run has no public bus; `instead` says what helps then.
    """
    with asking(), runs.supervisor(chosen) as run:
        about = run.ask("run")
        for folder in about["folders"]:
            use_folders([folder])
        bus = PublicBus(runs.public_bus(about, instead))
        try:
            yield about, _heard(bus, run)
        finally:
            bus.close()


def _heard(bus: PublicBus, run: Client) -> Iterator[Heard]:
    """Yields messages from now on, until the run ends."""
    look_us = monotonic_us() + _LOOK_US
    while True:
        select.select([bus.fileno()], [], [], max(0, look_us - monotonic_us()) / US_PER_S)
        try:
            message = bus.receive()
        except MessageError:  # a datagram of another program; the run names it
            continue
        if message is not None:
            channel, data, _ = message
            header = header_of(data)
            yield Heard(channel, data, header.time_us if header else 0)
        if monotonic_us() >= look_us:
            look_us = monotonic_us() + _LOOK_US
            try:
                run.ask("run")
            except ControlError:  # the run has ended
                return
