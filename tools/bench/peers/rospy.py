"""ROS 1 in Python: a topic a stage for ticks, one for dones, a topic a component for data; messages of genpy."""

import os
from pathlib import Path
from typing import Any

import genpy.dynamic
import rospy

from tools.bench.peers.inbox import Answers, Inbox
from tools.bench.shape import Shape
from tools.bench.timing import sleep_s

_MESSAGES = Path(__file__).parent / "ros"


def _generated(name: str, *parts: str) -> Any:
    """Returns the class of a .msg file and its parts, in the form of a bag's type definition."""
    texts = [(_MESSAGES / f"{name}.msg").read_text()]
    texts += [f"{'=' * 80}\nMSG: bench/{part}\n{(_MESSAGES / f'{part}.msg').read_text()}" for part in parts]
    return genpy.dynamic.generate_dynamic(f"bench/{name}", "".join(texts))[f"bench/{name}"]


Signal = _generated("Signal")
Sample = _generated("Sample", "Stamp")
_QUEUE = 1000


def supervisor(shape: Shape) -> "RospySupervisor":
    """The supervisor's side."""
    return RospySupervisor(shape)


def component(shape: Shape, index: int) -> "RospyComponent":
    """A component's side."""
    return RospyComponent(shape, index)


def _publisher(topic: str, kind: Any) -> Any:
    """Sends in the caller's thread: ROS's faster way for small messages."""
    return rospy.Publisher(topic, kind, queue_size=None, tcp_nodelay=True)


def _subscriber(topic: str, kind: Any, handler: Any) -> Any:
    return rospy.Subscriber(topic, kind, handler, queue_size=_QUEUE, tcp_nodelay=True)


class RospySupervisor:
    """A publisher a stage."""

    def __init__(self, shape: Shape) -> None:
        rospy.init_node("supervisor", disable_signals=True, disable_rosout=True)
        self._answers = Answers()
        self._dones = _subscriber("/done", Signal, self._on_done)
        self._ticks = [_publisher(f"/tick{stage}", Signal) for stage in range(shape.stages)]

    def _on_done(self, message: Any) -> None:
        self._answers.put(message.component, message.tick)

    def begin(self, stage: int, tick: int) -> None:
        self._ticks[stage].publish(Signal(tick, -1))

    def done(self, timeout_s: float) -> tuple[int, int] | None:
        return self._answers.take(timeout_s)

    def close(self) -> None:
        sleep_s(0.2)  # the last ticks are on their way


class RospyComponent:
    """Callbacks come from one thread for each connection."""

    def __init__(self, shape: Shape, index: int) -> None:
        rospy.init_node(f"c{index}", disable_signals=True, disable_rosout=True)
        self._index = index
        self._inbox: Inbox[Any] = Inbox(shape.sources(index))
        self._data = _publisher(f"/data{index}", Sample)
        self._dones = _publisher("/done", Signal)
        self._subscribers = [
            _subscriber(f"/data{source}", Sample, self._handler(source)) for source in shape.sources(index)
        ]
        self._subscribers.append(_subscriber(f"/tick{shape.stage(index)}", Signal, self._on_tick))

    def _handler(self, source: int) -> Any:
        return lambda message: self._inbox.put(source, message)

    def _on_tick(self, message: Any) -> None:
        self._inbox.put_tick(message.tick)

    def tick(self) -> int:
        return self._inbox.tick()

    def new_sample(self) -> Any:
        return Sample()

    def inputs(self) -> list[Any]:
        return self._inbox.newest()

    def publish(self, sample: Any) -> None:
        self._data.publish(sample)

    def done(self, tick: int) -> None:
        self._dones.publish(Signal(tick, self._index))

    def close(self) -> None:
        os._exit(0)  # rospy's threads have nothing left to do, and leaving the master one by one takes long
