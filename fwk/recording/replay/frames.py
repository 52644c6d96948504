"""Where components of a replay find camera frames: each those that it got in the run, whenever it is run here."""

from collections.abc import Callable
from pathlib import Path
from typing import Protocol

from fwk.component.images import Frame, Ring
from fwk.recording.pictures import RecordedPicture
from fwk.recording.replay.recording import RecordingError

_HELD = 2  # of the iteration that a component is late with, and of its end
_KEPT = 32  # nobody looks at frames older than the newest that it was told of


class FrameSource(Protocol):
    """Frames of one camera."""

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """Frame `number` as it can be had now, to be called at any time."""


class RingFrames:
    """Those that a camera gives out again in the replay."""

    def __init__(self, ring: Ring) -> None:
        self._ring = ring

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """As of any source."""
        pixels = self._ring.get(number, size)
        return lambda: pixels


class RecordedFrames:
    """Those that were recorded, in place of the camera."""

    def __init__(self, log: Path, channel: str) -> None:
        self._log = log
        self._channel = channel
        self._pictures: dict[int, RecordedPicture] = {}  # the newest, by number
        self._decoded: tuple[int, Frame] | None = None

    def add(self, picture: RecordedPicture) -> None:
        """The next one."""
        self._pictures[picture.frame] = picture
        if len(self._pictures) > _KEPT:
            del self._pictures[min(self._pictures)]

    def take(self, number: int, size: int) -> Callable[[], Frame | None]:
        """As of any source; what it returns raises RecordingError if the frame is not in the recording, or damaged."""
        picture = self._pictures.get(number)
        return lambda: self._pixels(number, size, picture)

    def _pixels(self, number: int, size: int, picture: RecordedPicture | None) -> Frame:
        if picture is None:
            raise RecordingError(
                f"{self._log}: frame {number} of {self._channel} is not in the recording, and the run's log says why; "
                "replay what is before it with --to-tick, or with --only those who do not look at that camera"
            )
        if self._decoded is None or self._decoded[0] != number:
            pixels = picture.pixels()
            if pixels is None or pixels.size != size:
                raise RecordingError(f"{self._log}: frame {number} of {self._channel} is damaged")
            self._decoded = (number, pixels.reshape(-1))
        return self._decoded[1].copy()


class View:
    """A camera as one start of a component sees it: without the frames that it missed in the run."""

    def __init__(self, source: FrameSource) -> None:
        self._source = source
        self._missed: set[int] = set()
        self._held: dict[int, Callable[[], Frame | None]] = {}

    def miss(self, number: int) -> None:
        """In the run this frame was overwritten before the component read it."""
        self._missed.add(number)

    def hold(self, number: int, size: int) -> None:
        """The component got this frame now, but is run later."""
        self._held[number] = self._source.take(number, size)
        while len(self._held) > _HELD:
            del self._held[min(self._held)]

    def get(self, number: int, size: int) -> Frame | None:
        """As of a ring."""
        if number in self._missed:
            return None
        return (self._held.get(number) or self._source.take(number, size))()
