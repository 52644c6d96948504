"""Bare LCM: a port a stage for ticks, one for dones, and one for the data of each ten components; no contract."""

from tools.bench.peers.lcm_links import LcmComponent, LcmSupervisor, UrlOf, url
from tools.bench.shape import Shape

_SHARE = 10


def _urls(shape: Shape) -> UrlOf:
    def url_of(channel: str) -> str:
        number = int(channel[4:] or 0)  # TICK3, DATA17, DONE
        if channel.startswith("DATA"):
            number //= _SHARE
        first = {"TICK": 1, "DONE": 0, "DATA": 1 + shape.stages}[channel[:4]]
        return url("udpm", shape.base_port + first + number)

    return url_of


def supervisor(shape: Shape) -> LcmSupervisor:
    """The supervisor\'s side."""
    return LcmSupervisor(shape, _urls(shape))


def component(shape: Shape, index: int) -> LcmComponent:
    """A component\'s side."""
    return LcmComponent(shape, index, _urls(shape))
