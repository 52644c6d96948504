"""Camera frames of a replay: each component gets the frames that it got in the run."""

import mmap
from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from fwk.component.images import Frame, Ring
from fwk.recording.pictures import RecordedPicture
from fwk.recording.replay.recording import RecordingError

_HELD = 2  # one for a late iteration, one for `finalize`
_KEPT = 32  # components never read frames older than the newest announced ones


class FrameSource(Protocol):
    """Frames of one camera."""

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """Returns a function that gives frame `number` of `size` bytes as it is now, whenever it is called."""


class RingFrames:
    """Frames of a camera that is replayed."""

    def __init__(self, ring: Ring) -> None:
        self._ring = ring

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """Returns a function that gives the frame as it is in the ring now."""
        pixels = self._ring.get(number, size)
        return lambda: pixels


def private_ring(channel: str) -> Ring:
    """Returns a ring that processes forked later do not share: each goes on with frames of its own."""
    return Ring(Ring.create(channel).descriptor, mmap.ACCESS_COPY)


class RecordedFrames:
    """Recorded frames of a camera."""

    def __init__(self, log: Path, channel: str) -> None:
        self._log = log
        self._channel = channel
        self._pictures: dict[int, RecordedPicture] = {}  # the newest, by number
        self._decoded: tuple[int, Frame] | None = None

    def add(self, picture: RecordedPicture) -> None:
        """Adds the next recorded frame."""
        self._pictures[picture.frame] = picture
        if len(self._pictures) > _KEPT:
            del self._pictures[min(self._pictures)]

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """Returns a function that gives the frame.

        The function raises RecordingError if the frame is damaged or was not recorded.
        """
        picture = self._pictures.get(number)
        return lambda: self._pixels(number, size, picture)

    def _pixels(self, number: int, size: int, picture: RecordedPicture | None) -> Frame:
        if picture is None:
            raise RecordingError(
                f"{self._log}: frame {number} of {self._channel} is not in the recording, and the run's log says why; "
                "replay the ticks before it with --to-tick, or choose components without that camera with --only"
            )
        if self._decoded is None or self._decoded[0] != number:
            pixels = picture.pixels()
            if pixels is None or pixels.size != size:
                raise RecordingError(f"{self._log}: frame {number} of {self._channel} is damaged")
            self._decoded = (number, pixels.reshape(-1))
        return self._decoded[1].copy()


class FrameView:
    """FrameView of a camera for one incarnation of a component, without the frames that it lost in the run."""

    def __init__(self, source: FrameSource) -> None:
        self._source = source
        self._missed: set[int] = set()
        self._held: dict[int, Callable[[], Frame | None]] = {}

    def miss(self, number: int) -> None:
        """Withholds a frame from the component: in the run it was overwritten before the component read it."""
        self._missed.add(number)

    def hold(self, number: int, size: int) -> None:
        """Keeps a frame for an iteration that runs later."""
        self._held[number] = self._source.take(number, size)
        while len(self._held) > _HELD:
            del self._held[min(self._held)]

    def get(self, number: int, size: int) -> Frame | None:
        """Returns the frame, as a ring does."""
        if number in self._missed:
            return None
        return (self._held.get(number) or self._source.take(number, size))()
