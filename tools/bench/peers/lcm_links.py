"""Both sides on liblcm, for any mapping of channels to LCM URLs; one LCM object for each URL a process needs."""

import struct
from collections import deque
from collections.abc import Callable

from lcm import LCM
from lcmtypes.bench import sample_t

from tools.bench.shape import Shape

_NUMBERS = struct.Struct(">ii")

UrlOf = Callable[[str], str]
"""Channel name (`TICK2`, `DONE`, `DATA17`) to URL."""


def url(scheme: str, port: int) -> str:
    """Returns a URL that stays on this machine, with a receive buffer that does not lose bursts."""
    return f"{scheme}://239.255.76.67:{port}?ttl=0&recv_buf_size=4194304"


class Links:
    """The LCM objects of a process; channels with the same URL share one."""

    def __init__(self, url_of: UrlOf) -> None:
        self._url_of = url_of
        self._links: dict[str, LCM] = {}

    def __getitem__(self, channel: str) -> LCM:
        wanted = self._url_of(channel)
        if wanted not in self._links:
            self._links[wanted] = LCM(wanted)
        return self._links[wanted]

    def subscribe(self, channel: str, handler: Callable[[str, bytes], None]) -> LCM:
        """Subscribes with an unlimited queue: the default of 30 messages loses a stage of forty dones."""
        link = self[channel]
        link.subscribe(channel, handler).set_queue_capacity(0)
        return link


class LcmSupervisor:
    """One publish reaches a whole stage."""

    def __init__(self, shape: Shape, url_of: UrlOf) -> None:
        self._links = Links(url_of)
        self._answers: deque[tuple[int, int]] = deque()
        self._dones = self._links.subscribe("DONE", self._on_done)
        self._ticks = [(f"TICK{stage}", self._links[f"TICK{stage}"]) for stage in range(shape.stages)]

    def _on_done(self, _: str, data: bytes) -> None:
        index, tick = _NUMBERS.unpack(data)
        self._answers.append((index, tick))

    def begin(self, stage: int, tick: int) -> None:
        channel, link = self._ticks[stage]
        link.publish(channel, _NUMBERS.pack(stage, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        if not self._answers:
            self._dones.handle_timeout(int(timeout_s * 1000))
        return self._answers.popleft() if self._answers else None

    def close(self) -> None:
        """LCM objects close with the process."""


class LcmComponent:
    """Takes the messages that have arrived when its tick comes, without waiting."""

    def __init__(self, shape: Shape, index: int, url_of: UrlOf) -> None:
        self._index = index
        self._links = Links(url_of)
        self._pending: deque[int] = deque()
        self._raw: dict[str, bytes] = {}
        self._channels = [f"DATA{source}" for source in shape.sources(index)]
        self._own = f"DATA{index}"
        self._out, self._dones = self._links[self._own], self._links["DONE"]
        inputs = [self._links.subscribe(channel, self._on_data) for channel in self._channels]
        self._inputs = list(dict.fromkeys(inputs))
        self._ticks = self._links.subscribe(f"TICK{shape.stage(index)}", self._on_tick)

    def _on_tick(self, _: str, data: bytes) -> None:
        self._pending.append(_NUMBERS.unpack(data)[1])

    def _on_data(self, channel: str, data: bytes) -> None:
        self._raw[channel] = data

    def tick(self) -> int:
        while not self._pending:
            self._ticks.handle()
        return self._pending.popleft()

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        for link in self._inputs:
            while link.handle_timeout(0):
                pass
        return [sample_t.decode(self._raw[channel]) if channel in self._raw else None for channel in self._channels]

    def publish(self, sample: sample_t) -> None:
        self._out.publish(self._own, sample.encode())

    def done(self, tick: int) -> None:
        self._dones.publish("DONE", _NUMBERS.pack(self._index, tick))

    def close(self) -> None:
        """LCM objects close with the process."""
