"""Makes a video of a recording: one picture a tick, drawn from the newest messages as they were at its end."""

from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from fwk.clock import US_PER_S
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import decoded, header_of

Picture = NDArray[np.uint8]
"""Height x width x 3, blue green red; the same size all the time, both even."""
Newest = Callable[[str], Any]
"""Channel to its newest message, decoded, or None before the first."""
Draw = Callable[[Newest], Picture | None]
"""None: nothing to show yet."""


class VideoError(Exception):
    """The video cannot be made; says which file or drawing and why."""


def drawing(name: str) -> Draw:
    """The drawing that `module:name` stands for: a function, or a class whose `draw` is used.

    Raises:
        VideoError: there is no such module or name.
    """
    module, _, word = name.partition(":")
    try:
        found = getattr(import_module(module), word)
    except (ImportError, AttributeError, ValueError) as error:
        raise VideoError(f"no drawing '{name}': {error}; say module:name, as my_robot.pictures:top_view") from error
    draw: Draw = found().draw if isinstance(found, type) else found
    return draw


def render_video(log: Path, out: Path, draw: Draw) -> int:
    """Draws every tick of a log into an mp4 file that plays at the speed of logical time.

    Returns the number of pictures.

    Raises:
        LogError: the log cannot be read.
        VideoError: there is nothing to show, the pictures differ in size, or the file cannot be written.
    """
    reader, newest = StampedLog(log), _Newest()
    writer: cv2.VideoWriter | None = None
    size, pictures = (0, 0), 0
    try:
        for _ in _ends_of_ticks(reader, newest):
            picture = draw(newest)
            if picture is None:
                continue
            if writer is None:
                size = (picture.shape[1], picture.shape[0])
                writer = cv2.VideoWriter(str(out), cv2.VideoWriter.fourcc(*"mp4v"), _ticks_per_s(reader), size)
                if not writer.isOpened():
                    raise VideoError(f"{out}: cannot write a video there; is there such a folder, and may you write?")
            if (picture.shape[1], picture.shape[0]) != size:
                wrong = f"{picture.shape[1]}x{picture.shape[0]}, not {size[0]}x{size[1]} as the first"
                raise VideoError(f"{log}: picture {pictures + 1} is {wrong}")
            writer.write(picture)
            pictures += 1
    finally:
        if writer is not None:
            writer.release()
    if not pictures:
        raise VideoError(f"{log}: nothing to show: the drawing found none of the messages that it needs")
    written = round(cv2.VideoCapture(str(out)).get(cv2.CAP_PROP_FRAME_COUNT))  # the writer itself reports nothing
    if written != pictures:
        raise VideoError(f"{out}: cannot be written: {written} of {pictures} pictures are in it; is there room?")
    return pictures


class _Newest:
    """The newest message of each channel, decoded when asked for."""

    def __init__(self) -> None:
        self._raw: dict[str, bytes] = {}
        self._decoded: dict[str, Any] = {}

    def take(self, channel: str, data: bytes) -> None:
        self._raw[channel] = data
        self._decoded.pop(channel, None)

    def __call__(self, channel: str) -> Any:
        if channel not in self._decoded and channel in self._raw:
            data = self._raw[channel]
            try:
                self._decoded[channel] = decoded(data)
            except Exception:  # no type, or whatever generated code does with broken bytes: as if it were not there
                self._decoded[channel] = None
        return self._decoded.get(channel)


def _ends_of_ticks(reader: StampedLog, newest: _Newest) -> Iterator[int]:
    """Yields each tick when all its messages are in `newest`."""
    tick = None
    for event in reader:
        head = header_of(event.data)
        if head is None:
            continue
        if tick is not None and head.tick > tick:
            yield tick
        tick = head.tick if tick is None else max(tick, head.tick)
        newest.take(event.channel, event.data)
    if tick is not None:
        yield tick


def _ticks_per_s(reader: StampedLog) -> float:
    """From the logical times of the first two ticks; one picture a second if there is only one."""
    heads = (header_of(event.data) for event in reader)
    first = None
    for head in heads:
        if head is None:
            continue
        if first is None:
            first = head
        elif head.tick > first.tick and head.time_us > first.time_us:
            return US_PER_S * (head.tick - first.tick) / (head.time_us - first.time_us)
    return 1.0
