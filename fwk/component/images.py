"""The vision aspects: camera frames in a shared-memory ring, written by one vision master and read by many."""

import math
import mmap
import os
import struct
from collections.abc import ItemsView, Iterator, Mapping
from pathlib import Path
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from fwk.component.channels import Reads, Writes
from fwk.component.log import Logger
from lcmtypes.core import frame_t

SLOTS = 4
"""Of a ring; one less may be given out in an iteration."""
SLOT_BYTES = 8 << 20  # room for the largest frame; memory is used only where a frame was written
_MARKS = struct.Struct("=qq")  # frame number before and after the pixels: different while a frame is being written
_SHAPE = struct.Struct("=3i")  # height, width, channels; behind the marks
_PAGE = mmap.PAGESIZE
_TRIES = 100  # of somebody who looks at a ring from outside, while the camera goes on

Frame = NDArray[np.uint8]


class FrameError(Exception):
    """A frame does not fit into its ring, or too many were written in one iteration."""


class Frames(Protocol):
    """Where somebody who was told of a frame finds it: a ring, or in a replay a recording."""

    def get(self, number: int, size: int) -> Frame | None:
        """A copy of frame `number`; None if it is no longer to be had."""


class Ring:
    """A few frames in anonymous shared memory; it vanishes with the last process that has it, whatever kills it."""

    def __init__(self, descriptor: int, access: int = mmap.ACCESS_WRITE) -> None:
        self.descriptor = descriptor
        self.slots = os.fstat(descriptor).st_size // (_PAGE + SLOT_BYTES)
        self._memory = mmap.mmap(descriptor, 0, access=access)

    @classmethod
    def create(cls, name: str, slots: int = SLOTS) -> "Ring":
        """Makes a new ring; processes forked afterwards share it, others open `/proc/<pid>/fd/<descriptor>`."""
        descriptor = os.memfd_create(name)
        os.ftruncate(descriptor, slots * (_PAGE + SLOT_BYTES))
        return cls(descriptor)

    @classmethod
    def of_process(cls, pid: int, name: str) -> Self | None:
        """The ring of that name among the open files of another process, to read; None if it has none.

        The kernel allows it to the user of that process and to root.
        """
        for link in Path(f"/proc/{pid}/fd").iterdir():
            try:
                if os.readlink(link).startswith(f"/memfd:{name} "):
                    return cls(os.open(link, os.O_RDONLY), mmap.ACCESS_READ)
            except FileNotFoundError:  # closed meanwhile
                continue
        return None

    def put(self, number: int, pixels: Frame) -> None:
        """Writes frame `number`."""
        start = (number % self.slots) * (_PAGE + SLOT_BYTES)
        _MARKS.pack_into(self._memory, start, number, -1)
        _SHAPE.pack_into(self._memory, start + _MARKS.size, *pixels.shape[:2], _channels(pixels))
        target = np.frombuffer(self._memory, np.uint8, pixels.size, start + _PAGE)
        np.copyto(target, pixels.reshape(-1))
        _MARKS.pack_into(self._memory, start, number, number)

    def get(self, number: int, size: int) -> Frame | None:
        """A copy of frame `number`, or None if it has been overwritten: never a torn one."""
        start = (number % self.slots) * (_PAGE + SLOT_BYTES)
        if not 0 < size <= SLOT_BYTES or _MARKS.unpack_from(self._memory, start) != (number, number):
            return None
        pixels = np.frombuffer(self._memory, np.uint8, size, start + _PAGE).copy()
        return pixels if _MARKS.unpack_from(self._memory, start) == (number, number) else None

    def newest(self) -> tuple[int, Frame] | None:
        """Number and copy of the newest frame, for somebody who is not told of them; None before the first."""
        starts = [slot * (_PAGE + SLOT_BYTES) for slot in range(self.slots)]
        for _ in range(_TRIES):
            marks = [(*_MARKS.unpack_from(self._memory, start), start) for start in starts]
            whole = [(before, start) for before, after, start in marks if before == after > 0]
            if whole:
                number, start = max(whole)
                shape = shape_of(*_SHAPE.unpack_from(self._memory, start + _MARKS.size))
                pixels = self.get(number, math.prod(shape))
                if pixels is not None:
                    return number, pixels.reshape(shape)
        return None


def shape_of(height_px: int, width_px: int, channels: int) -> tuple[int, ...]:
    """The shape of a frame's array: pictures of one channel have two dimensions."""
    return (height_px, width_px, channels) if channels > 1 else (height_px, width_px)


def _channels(pixels: Frame) -> int:
    return pixels.shape[2] if pixels.ndim == 3 else 1


class VisionMaster:
    """The vision-master aspect: gives out the frames of one camera.

    Frames are arrays of bytes, height x width x channels (3: bgr8) or height x width (gray8).
    """

    def __init__(self, announcement: Writes[frame_t], ring: Ring) -> None:
        self.announcement = announcement
        self._ring = ring

    def publish(self, pixels: Frame) -> None:
        """Puts a frame into the ring and announces it at the end of the iteration.

        Raises:
            FrameError: it is larger than a slot, no uint8 array of two or three dimensions, or the ring would
                overwrite a frame of the same iteration.
        """
        if pixels.dtype != np.uint8 or pixels.ndim not in (2, 3) or not 0 < pixels.size <= SLOT_BYTES:
            raise FrameError(
                f"{self.announcement.channel}: a frame is a uint8 array, height x width (x channels), of at most "
                f"{SLOT_BYTES} bytes, not {pixels.dtype} {pixels.shape}"
            )
        if self.announcement.pending >= SLOTS - 1:
            raise FrameError(f"{self.announcement.channel}: at most {SLOTS - 1} frames in one iteration")
        frame = self.announcement.value
        frame.frame = self.announcement.sequence + self.announcement.pending + 1  # goes on when the master is restarted
        frame.slot = frame.frame % SLOTS  # the same in every run, however many slots the ring has
        self._ring.put(frame.frame, np.ascontiguousarray(pixels))
        frame.height_px, frame.width_px = pixels.shape[:2]
        frame.channels = _channels(pixels)
        frame.encoding = "bgr8" if frame.channels == 3 else "gray8"
        self.announcement.write()


class Image:
    """The vision aspect: the newest frame of one camera as of the iteration's beginning.

    In lockstep it is always there. In real time one who comes very late may find it overwritten: that is counted in
    `lost` and logged at the 1st, 10th, 100th time.
    """

    def __init__(self, announcement: Reads[frame_t], frames: Frames, log: Logger) -> None:
        self.announcement = announcement
        self.lost = 0  # frames that were overwritten before this component came to read them
        self._missed: list[int] = []
        self._frames = frames
        self._log = log
        self._number = -1
        self._pixels: Frame | None = None

    @property
    def changed(self) -> bool:
        """Whether a new frame came since the last iteration."""
        return self.announcement.refreshed

    @property
    def header(self) -> Any:
        """Tick, stage, sequence, writer and logical time of the frame."""
        return self.announcement.header

    @property
    def pixels(self) -> Frame | None:
        """The frame, height x width x channels, a copy; None before the first and if it was overwritten."""
        frame = self.announcement.value
        if frame.frame != self._number:
            self._number = frame.frame
            flat = (
                self._frames.get(frame.frame, frame.height_px * frame.width_px * frame.channels)
                if frame.frame
                else None
            )
            shape = shape_of(frame.height_px, frame.width_px, frame.channels)
            self._pixels = None if flat is None else flat.reshape(shape)
            if flat is None and frame.frame:
                self._lose(frame.frame)
        return self._pixels

    def missed(self) -> list[int]:
        """Numbers of the frames lost since the last call; the recording has them, so that a replay loses the same."""
        taken, self._missed = self._missed, []
        return taken

    def _lose(self, number: int) -> None:
        self.lost += 1
        self._missed.append(number)
        if str(self.lost).strip("0") == "1":
            self._log.warning(
                f"{self.announcement.channel}: frame {number} was overwritten before it was read "
                f"({self.lost} lost so far)"
            )


class ImagesEach(Mapping[str, Image]):
    """The frames of many cameras, by namespace, in alphabetical order; nobody of them is needed for a start."""

    def __init__(self, images: Mapping[str, Image]) -> None:
        self._images = dict(sorted(images.items()))

    def __getitem__(self, key: str) -> Image:
        return self._images[key]

    def __iter__(self) -> Iterator[str]:
        return iter(self._images)

    def __len__(self) -> int:
        return len(self._images)

    def items(self) -> ItemsView[str, Image]:
        """Pairs of namespace and camera."""
        return self._images.items()
