"""Ice: the supervisor calls all components of a stage at once (AMI), their answers are the dones; data goes oneway."""

import os
import sys
from concurrent.futures import Future
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from typing import Any

import Ice

from tools.bench.peers.inbox import Answers
from tools.bench.shape import Shape
from tools.bench.sides import STOP

_SLICE = r"""
module Bench {
  struct Stamp { long tick; long \sequence; long time_us; short stage; string writer; };
  sequence<double> Doubles;
  sequence<byte> Bytes;
  struct Sample { Stamp header; double x_m; double y_m; double heading_rad; double confidence;
                  Doubles covariance; int n_padding; Bytes padding; };
  interface Component {
    int iterate(int tick);
    void put(int source, Sample message);
  };
};
"""


def _load_slice() -> Any:
    with TemporaryDirectory() as folder:
        path = Path(folder, "bench.ice")
        path.write_text(_SLICE)
        Ice.loadSlice(f"--underscore {path}")
    return sys.modules["Bench"]


Bench = _load_slice()


def supervisor(shape: Shape) -> "IceSupervisor":
    """The supervisor's side."""
    return IceSupervisor(shape)


def component(shape: Shape, index: int) -> "IceComponent":
    """A component's side."""
    return IceComponent(shape, index)


def _communicator() -> Any:
    settings = Ice.InitializationData()
    settings.properties = Ice.createProperties()
    for name, value in {
        "Ice.ThreadPool.Server.Size": "1",
        "Ice.Default.Host": "127.0.0.1",
        "Ice.RetryIntervals": "-1",
        "Ice.MessageSizeMax": "4096",
    }.items():
        settings.properties.setProperty(name, value)
    return Ice.initialize(settings)


def _proxy(communicator: Any, shape: Shape, index: int) -> Any:
    return Bench.ComponentPrx.uncheckedCast(
        communicator.stringToProxy(f"component:tcp -h 127.0.0.1 -p {shape.base_port + index}")
    )


class IceSupervisor:
    """Calls all components without waiting, then takes the answers as they come."""

    def __init__(self, shape: Shape) -> None:
        self._communicator = _communicator()
        self._answers = Answers()
        self._members = [
            [(index, _proxy(self._communicator, shape, index)) for index in shape.members(stage)]
            for stage in range(shape.stages)
        ]

    def begin(self, stage: int, tick: int) -> None:
        for index, proxy in self._members[stage]:
            proxy.iterateAsync(tick).add_done_callback(self._handler(index))

    def _handler(self, index: int) -> Any:
        def answered(future: Any) -> None:
            if future.exception() is None:  # not started yet, or ended
                self._answers.put(index, future.result())

        return answered

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        return self._answers.take(timeout_s)

    def close(self) -> None:
        self._communicator.destroy()


class _Servant(Bench.Component):  # type: ignore[misc,name-defined]  # made from Slice at run time
    def __init__(self, sources: list[int]) -> None:
        self.calls: SimpleQueue[tuple[int, Future[int]]] = SimpleQueue()
        self.newest: dict[int, Any] = dict.fromkeys(sources)

    def iterate(self, tick: int, _current: Any = None) -> "Future[int]":
        answer: Future[int] = Future()
        self.calls.put((tick, answer))
        return answer

    def put(self, source: int, message: Any, _current: Any = None) -> None:
        self.newest[source] = message


class IceComponent:
    """A server whose `iterate` is answered when the iteration is over (AMD); writers call each reader's `put`."""

    def __init__(self, shape: Shape, index: int) -> None:
        self._index = index
        self._communicator = _communicator()
        self._servant = _Servant(shape.sources(index))
        adapter = self._communicator.createObjectAdapterWithEndpoints(
            "component", f"tcp -h 127.0.0.1 -p {shape.base_port + index}"
        )
        adapter.add(self._servant, Ice.stringToIdentity("component"))
        adapter.activate()
        self._readers = [_proxy(self._communicator, shape, reader).ice_oneway() for reader in shape.readers(index)]
        self._answer: Future[int] = Future()

    def tick(self) -> int:
        tick, self._answer = self._servant.calls.get()
        if tick == STOP:
            self._answer.set_result(tick)
        return tick

    def new_sample(self) -> Any:
        return Bench.Sample(header=Bench.Stamp())

    def inputs(self) -> list[Any]:
        return list(self._servant.newest.values())

    def publish(self, sample: Any) -> None:
        for reader in self._readers:
            try:
                reader.put(self._index, sample)
            except Ice.ConnectFailedException:  # not started yet
                continue

    def done(self, tick: int) -> None:
        self._answer.set_result(tick)

    def close(self) -> None:
        # destroying the communicator waits for connections of other processes that end at the same time
        os._exit(0)
