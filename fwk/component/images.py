"""The vision aspects: camera frames in shared memory, written by one vision master and read by many components."""

import math
import mmap
import os
import struct
from pathlib import Path
from typing import Any, Protocol, Self

import numpy as np
from numpy.typing import NDArray

from fwk.component.channels import Reads, Writes
from fwk.component.log import Logger
from lcmtypes.core import frame_t

SLOTS = 4
"""Frames in a ring; a vision master may publish one less in an iteration."""
SLOT_BYTES = 8 << 20  # size of the largest frame; only written parts take up memory
_MARKS = struct.Struct("=qq")  # frame number before and after the pixels; they differ during a write
_SHAPE = struct.Struct("=3i")  # height, width, channels; after the marks
_PAGE = mmap.PAGESIZE
_TRIES = 100  # attempts to read the newest frame while the camera writes

Frame = NDArray[np.uint8]


class FrameError(Exception):
    """A frame does not fit into its ring, or too many frames were published in one iteration."""


class Frames(Protocol):
    """Store of announced frames: a ring, or a recording in a replay."""

    def get(self, number: int, size: int) -> Frame | None:
        """Returns a copy of frame `number` as `size` bytes; None if the frame is gone."""


class Ring:
    """The newest frames of a camera in anonymous shared memory, which is freed with the last process that maps it."""

    def __init__(self, descriptor: int, access: int = mmap.ACCESS_WRITE) -> None:
        self.descriptor = descriptor
        self.slots = os.fstat(descriptor).st_size // (_PAGE + SLOT_BYTES)
        self._memory = mmap.mmap(descriptor, 0, access=access)

    @classmethod
    def create(cls, name: str, slots: int = SLOTS) -> "Ring":
        """Makes a ring. Processes forked later share it; other processes open `/proc/<pid>/fd/<descriptor>`."""
        descriptor = os.memfd_create(name)
        os.ftruncate(descriptor, slots * (_PAGE + SLOT_BYTES))
        return cls(descriptor)

    @classmethod
    def of_process(cls, pid: int, name: str) -> Self | None:
        """Opens the ring of that name in another process, read-only; None if the process has no such ring.

        The kernel allows this to the user of that process and to root.
        """
        for link in Path(f"/proc/{pid}/fd").iterdir():
            try:
                if os.readlink(link).startswith(f"/memfd:{name} "):
                    return cls(os.open(link, os.O_RDONLY), mmap.ACCESS_READ)
            except FileNotFoundError:  # closed in between
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
        """Returns a copy of frame `number` as `size` bytes, never a torn frame; None if it was overwritten."""
        start = (number % self.slots) * (_PAGE + SLOT_BYTES)
        if not 0 < size <= SLOT_BYTES or _MARKS.unpack_from(self._memory, start) != (number, number):
            return None
        pixels = np.frombuffer(self._memory, np.uint8, size, start + _PAGE).copy()
        return pixels if _MARKS.unpack_from(self._memory, start) == (number, number) else None

    def newest(self, wanted: int = 0) -> tuple[int, Frame] | None:
        """Returns number and copy of the newest frame, or of a wanted one if the ring still holds it.

        For readers without announcements. None before the first frame.
        """
        starts = [slot * (_PAGE + SLOT_BYTES) for slot in range(self.slots)]
        for _ in range(_TRIES):
            marks = [(*_MARKS.unpack_from(self._memory, start), start) for start in starts]
            whole = [(before, start) for before, after, start in marks if before == after > 0]
            if whole:
                number, start = max(whole, key=lambda each: (each[0] == wanted, each[0]))
                shape = shape_of(*_SHAPE.unpack_from(self._memory, start + _MARKS.size))
                pixels = self.get(number, math.prod(shape))
                if pixels is not None:
                    return number, pixels.reshape(shape)
        return None


def shape_of(height_px: int, width_px: int, channels: int) -> tuple[int, ...]:
    """Returns the shape of a frame's array; frames of one channel have two dimensions."""
    return (height_px, width_px, channels) if channels > 1 else (height_px, width_px)


def _channels(pixels: Frame) -> int:
    return pixels.shape[2] if pixels.ndim == 3 else 1


class VisionMaster:
    """Publishes the frames of one camera; the vision-master aspect.

    Frames are arrays of bytes, height x width x channels (3: bgr8) or height x width (gray8).
    """

    def __init__(self, announcement: Writes[frame_t], ring: Ring) -> None:
        self._announcement = announcement
        self._ring = ring

    def publish(self, pixels: Frame, capture_us: int = 0) -> None:
        """Puts a frame into the ring and announces it at the end of the iteration.

        `capture_us` is the logical time of the exposure; 0 if it is not known.

        Raises:
            FrameError: the frame is larger than a slot or not a uint8 array of two or three dimensions, or the ring
                would overwrite a frame of the same iteration.
        """
        if pixels.dtype != np.uint8 or pixels.ndim not in (2, 3) or not 0 < pixels.size <= SLOT_BYTES:
            raise FrameError(
                f"{self._announcement.channel}: a frame is a uint8 array, height x width (x channels), of at most "
                f"{SLOT_BYTES} bytes, not {pixels.dtype} {pixels.shape}"
            )
        pending = len(self._announcement._pending)
        if pending >= SLOTS - 1:
            raise FrameError(f"{self._announcement.channel}: at most {SLOTS - 1} frames in one iteration")
        frame = self._announcement.value
        frame.frame = self._announcement.sequence + pending + 1  # continues when the master is restarted
        frame.slot = frame.frame % SLOTS  # the same in every run, for any number of slots
        self._ring.put(frame.frame, np.ascontiguousarray(pixels))
        frame.height_px, frame.width_px = pixels.shape[:2]
        frame.channels = _channels(pixels)
        frame.capture_us = capture_us
        frame.encoding = "bgr8" if frame.channels == 3 else "gray8"
        self._announcement.write()


class Image:
    """Newest frame of one camera at the beginning of the iteration; the vision aspect.

    In lockstep the frame is always there. In real time a very late component may find it overwritten: such frames are
    counted in `lost` and logged at the 1st, 10th, 100th time.
    """

    def __init__(self, announcement: Reads[frame_t], frames: Frames, log: Logger) -> None:
        self.announcement = announcement
        """Reader of the frame's announcement: number, size, encoding."""
        self.lost = 0
        """Number of frames that were overwritten before this component read them."""
        self._missed: list[int] = []
        self._frames = frames
        self._log = log
        self._number = -1
        self._pixels: Frame | None = None

    @property
    def changed(self) -> bool:
        """Whether a new frame became visible since the last iteration."""
        return self.announcement.refreshed

    @property
    def header(self) -> Any:
        """Tick, stage, sequence number, writer and logical time of the frame."""
        return self.announcement.header

    @property
    def pixels(self) -> Frame | None:
        """Copy of the frame, height x width x channels; None before the first frame and if it was overwritten."""
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

    def _take_missed(self) -> list[int]:
        """Returns the numbers of frames lost since the last call; a replay loses the same frames."""
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
