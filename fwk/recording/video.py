"""Makes a video of a recording: one picture for each tick, drawn from the newest messages at its end."""

import contextlib
import fnmatch
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from fwk.clock import US_PER_S
from fwk.lcm.messages import Header
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import decoded, header_of
from fwk.recording.versions import PLAN, read_plan
from fwk.recording.video_encoder import Encoder, EncoderError, Picture, open_encoder

Newest = Callable[[str], Any]
"""Channel to its newest message, decoded, or None before the first. Drawings of recordings also get `settings`, which
returns settings of the run as `fwk.web.Newest.settings` does."""
Draw = Callable[[Newest], Picture | None]
"""Returns a picture, or None while there is nothing to show."""
Progress = Callable[[int, float], None]
"""Takes the number of pictures so far, and the logical time of the newest in seconds."""


class Rendered(NamedTuple):
    """A finished video."""

    pictures: int
    codec: str


class VideoError(Exception):
    """A video cannot be made; the text names the file or drawing and the reason."""


def drawing(name: str) -> Draw:
    """Returns the drawing named `module:name`: a function, or the `draw` of a class.

    Raises:
        VideoError: the module or the name in it does not exist.
    """
    module, _, word = name.partition(":")
    try:
        found = getattr(import_module(module), word)
    except (ImportError, AttributeError, ValueError) as error:
        raise VideoError(f"no drawing '{name}': {error}; use module:name, as my_robot.pictures:top_view") from error
    draw: Draw = found().draw if isinstance(found, type) else found
    return draw


def render_video(log: Path, out: Path, draw: Draw, progress: Progress = lambda *_: None) -> Rendered:
    """Draws every tick of a log into an mp4 file that plays at the speed of logical time.

    `progress` is called after each picture with the number of pictures and the logical time in seconds. When it, or the
    drawing, raises an exception, the file holds the pictures until then and can be played.

    Raises:
        LogError: the log cannot be read.
        VideoError: there is nothing to show, the pictures differ in size, or the file cannot be written.
    """
    reader, newest = StampedLog(log), _Newest()
    encoder: Encoder | None = None
    size, pictures = (0, 0), 0
    try:
        for head in _ends_of_ticks(reader, newest):
            picture = draw(newest)
            if picture is None:
                continue
            if encoder is None:
                size = (picture.shape[1], picture.shape[0])
                encoder = open_encoder(out, _ticks_per_s(reader), *size)
            if (picture.shape[1], picture.shape[0]) != size:
                wrong = f"{picture.shape[1]}x{picture.shape[0]}, not {size[0]}x{size[1]} as the first"
                raise VideoError(f"{log}: picture {pictures + 1} is {wrong}")
            encoder.write(picture)
            pictures += 1
            progress(pictures, head.time_us / US_PER_S)
        if encoder is None:
            raise VideoError(f"{log}: nothing to show: the drawing found none of the messages that it needs")
        finished, encoder = encoder, None
        finished.close()
    except EncoderError as error:
        raise VideoError(str(error)) from error
    finally:
        if encoder is not None:
            with contextlib.suppress(EncoderError):
                encoder.close()
    return Rendered(pictures, finished.codec)


class _Newest:
    """Newest message of each channel, decoded on demand, and the settings of the recorded run."""

    def __init__(self) -> None:
        self._configs: dict[str, dict[str, Any]] = {}
        self._raw: dict[str, bytes] = {}
        self._decoded: dict[str, Any] = {}

    def take(self, channel: str, data: bytes) -> None:
        self._raw[channel] = data
        self._decoded.pop(channel, None)

    def take_plan(self, data: bytes) -> None:
        self._configs = {}
        with contextlib.suppress(Exception):  # unreadable: as if there were no plan
            self._configs = {each.name: each.config for each in read_plan(data)[0].components}

    def settings(self, components: str, name: str) -> dict[str, Any]:
        """Returns the settings below `name` of the first component that has them, when the run started; empty: none.

        Args:
            components: pattern of the names of the components.
            name: name of the group of settings, such as `mirror`.
        """
        found = (self._configs[each].get(name) for each in sorted(fnmatch.filter(self._configs, components)))
        return next((group for group in found if isinstance(group, dict)), {})

    def __call__(self, channel: str) -> Any:
        if channel not in self._decoded and channel in self._raw:
            data = self._raw[channel]
            try:
                self._decoded[channel] = decoded(data)
            except Exception:  # undecodable: as if the message did not exist
                self._decoded[channel] = None
        return self._decoded.get(channel)


def _ends_of_ticks(reader: StampedLog, newest: _Newest) -> Iterator[Header]:
    """Yields a header of each tick when all messages of the tick are in `newest`."""
    last: Header | None = None
    for event in reader:
        if event.channel == PLAN:
            newest.take_plan(event.data)
        head = header_of(event.data)
        if head is None:
            continue
        if last is not None and head.tick > last.tick:
            yield last
        last = head if last is None or head.tick > last.tick else last
        newest.take(event.channel, event.data)
    if last is not None:
        yield last


def _ticks_per_s(reader: StampedLog) -> float:
    """Returns the rate of the first two ticks in logical time; 1 if there is only one tick."""
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
