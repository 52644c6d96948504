"""dora: a dataflow whose nodes are the supervisor and the components; bytes travel as Arrow arrays."""

import os
import struct
from typing import Any

from dora import Node
from lcmtypes.bench import sample_t

from tools.bench.shape import Shape
from tools.bench.sides import STOP
from tools.bench.timing import now_us, sleep_s

_NUMBERS = struct.Struct("=ii")


def supervisor(_: Shape) -> "DoraSupervisor":
    """The supervisor's side."""
    return DoraSupervisor()


def component(shape: Shape, index: int) -> "DoraComponent":
    """A component's side."""
    return DoraComponent(shape, index)


def _bytes(event: Any) -> bytes:
    made: bytes = event["value"].to_numpy().tobytes()
    return made


class DoraSupervisor:
    """An output a stage, an input a component."""

    def __init__(self) -> None:
        self._node = Node()

    def begin(self, stage: int, tick: int) -> None:
        self._node.send_output(f"tick{stage}", _NUMBERS.pack(stage, tick))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        end_us = now_us() + int(timeout_s * 1e6)
        while (left_us := end_us - now_us()) > 0:
            event = self._node.next(timeout=left_us / 1e6)
            if event and event["type"] == "INPUT":
                index, tick = _NUMBERS.unpack(_bytes(event))
                return index, tick
        return None

    def close(self) -> None:
        sleep_s(0.2)  # the last ticks are on their way


class DoraComponent:
    """Takes one event after the other: all data that came before its tick have arrived."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._index = index
        self._node = Node()
        self._raw: dict[str, bytes | None] = {f"data{source}": None for source in shape.sources(index)}

    def tick(self) -> int:
        while True:
            event = self._node.next()
            if event is None or event["type"] == "STOP":
                return STOP
            if event["type"] == "INPUT":
                if event["id"] == "tick":
                    tick: int = _NUMBERS.unpack(_bytes(event))[1]
                    return tick
                self._raw[event["id"]] = _bytes(event)

    def new_sample(self) -> sample_t:
        return sample_t()

    def inputs(self) -> list[sample_t | None]:
        return [sample_t.decode(data) if data is not None else None for data in self._raw.values()]

    def publish(self, sample: sample_t) -> None:
        self._node.send_output("data", sample.encode())

    def done(self, tick: int) -> None:
        self._node.send_output("done", _NUMBERS.pack(self._index, tick))

    def close(self) -> None:
        os._exit(0)  # the dataflow is a cycle: no node would learn that its inputs have ended
