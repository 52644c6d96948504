"""Bare LCM as a newcomer would use it: everything on one udpm URL; no contract."""

from tools.bench.peers.lcm_links import LcmComponent, LcmSupervisor, UrlOf, url
from tools.bench.shape import Shape


def _urls(shape: Shape) -> UrlOf:
    return lambda _: url("udpm", shape.base_port)


def supervisor(shape: Shape) -> LcmSupervisor:
    """The supervisor\'s side."""
    return LcmSupervisor(shape, _urls(shape))


def component(shape: Shape, index: int) -> LcmComponent:
    """A component\'s side."""
    return LcmComponent(shape, index, _urls(shape))
