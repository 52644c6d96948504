"""Zenoh: components are clients of the supervisor's session, which routes; ticks, dones and data are put to keys."""

import json
import struct
from typing import Any

import zenoh
from lcmtypes.bench import sample_t

from tools.bench.peers.inbox import Answers, Inbox
from tools.bench.shape import Shape
from tools.bench.timing import now_us, sleep_s

_NUMBERS = struct.Struct("=ii")
_PATIENCE_US = 60_000_000


def supervisor(shape: Shape) -> "ZenohSupervisor":
    """The supervisor's side."""
    return ZenohSupervisor(shape)


def component(shape: Shape, index: int) -> "ZenohComponent":
    """A component's side."""
    return ZenohComponent(shape, index)


def _session(shape: Shape, mode: str, verb: str) -> Any:
    """Opens a session; waits for the supervisor, which may start later."""
    config = zenoh.Config()
    config.insert_json5("mode", json.dumps(mode))
    config.insert_json5("scouting/multicast/enabled", "false")
    config.insert_json5(f"{verb}/endpoints", json.dumps([f"tcp/127.0.0.1:{shape.base_port}"]))
    end_us = now_us() + _PATIENCE_US
    while True:
        try:
            return zenoh.open(config)
        except zenoh.ZError:
            if now_us() > end_us:
                raise
            sleep_s(0.05)


class ZenohSupervisor:
    """Routes between the components, too."""

    def __init__(self, shape: Shape) -> None:
        self._session = _session(shape, "router", "listen")
        self._answers = Answers()
        self._dones = self._session.declare_subscriber("bench/done", self._on_done)
        self._ticks = [self._session.declare_publisher(f"bench/tick/{stage}") for stage in range(shape.stages)]

    def _on_done(self, sample: Any) -> None:
        self._answers.put(*_NUMBERS.unpack(sample.payload.to_bytes()))

    def begin(self, stage: int, tick: int) -> None:
        self._ticks[stage].put(_NUMBERS.pack(stage, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        return self._answers.take(timeout_s)

    def close(self) -> None:
        sleep_s(0.2)  # the last ticks are on their way
        self._session.close()


class ZenohComponent:
    """Callbacks come from a thread of Zenoh's."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._index = index
        self._session = _session(shape, "client", "connect")
        self._inbox: Inbox[bytes] = Inbox(shape.sources(index))
        self._data = self._session.declare_publisher(f"bench/data/{index}")
        self._dones = self._session.declare_publisher("bench/done")
        self._subscribers = [
            self._session.declare_subscriber(f"bench/data/{source}", self._handler(source))
            for source in shape.sources(index)
        ]
        self._subscribers.append(self._session.declare_subscriber(f"bench/tick/{shape.stage(index)}", self._on_tick))

    def _handler(self, source: int) -> Any:
        return lambda sample: self._inbox.put(source, sample.payload.to_bytes())

    def _on_tick(self, sample: Any) -> None:
        self._inbox.put_tick(_NUMBERS.unpack(sample.payload.to_bytes())[1])

    def tick(self) -> int:
        return self._inbox.tick()

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        return [sample_t.decode(data) if data is not None else None for data in self._inbox.newest()]

    def publish(self, sample: sample_t) -> None:
        self._data.put(sample.encode())

    def done(self, tick: int) -> None:
        self._dones.put(_NUMBERS.pack(self._index, tick))

    def close(self) -> None:
        self._session.close()
