"""Recorded pictures by number: frames of a video file, or the pictures in a folder."""

import re
from pathlib import Path
from typing import Protocol

import cv2
import numpy as np

from procs.vision.colours import Picture

PICTURES = (".bmp", ".jpeg", ".jpg", ".pgm", ".png", ".ppm", ".tif", ".tiff", ".webp")


class SourceError(Exception):
    """Pictures cannot be read; the message names the source, the reason, and a remedy."""


class Recorded(Protocol):
    """Numbered pictures, the same at each access."""

    def picture(self, number: int) -> Picture | None:
        """Returns picture `number`, from 0; None after the last.

        Raises:
            SourceError: the picture is damaged.
        """

    @property
    def count(self) -> int:
        """Number of pictures; 0 if it is endless, or not known before the last picture was read."""

    def close(self) -> None:
        """Releases the source."""


class Folder:
    """Picture files of a folder, apart from hidden ones, in natural order of their names: 2 before 10."""

    def __init__(self, path: Path) -> None:
        """Lists the pictures.

        Raises:
            SourceError: the folder contains no pictures.
        """
        files = [file for file in path.iterdir() if _is_picture(file)]
        self._files = sorted(files, key=lambda file: _natural(file.name))
        if not files:
            raise SourceError(f"'{path}': no pictures in this folder; they end in {', '.join(PICTURES)}")

    def picture(self, number: int) -> Picture | None:
        if number >= len(self._files):
            return None
        pixels = cv2.imread(str(self._files[number]), cv2.IMREAD_COLOR)
        if pixels is None:
            raise SourceError(f"'{self._files[number]}': not a readable picture; is it damaged?")
        return np.asarray(pixels, np.uint8)

    @property
    def count(self) -> int:
        return len(self._files)

    def close(self) -> None:
        """Does nothing: no file is open."""


class Video:
    """Frames of a video file, counted while they are decoded, because seeking in the file would not be exact."""

    def __init__(self, path: Path) -> None:
        """Opens the file.

        Raises:
            SourceError: the file cannot be read.
        """
        self._path = path
        self._next = 0
        self._count = 0
        self._capture = self._open()

    def picture(self, number: int) -> Picture | None:
        if self._count and number >= self._count:
            return None
        if number < self._next:
            self._capture.release()
            self._capture, self._next = self._open(), 0
        while self._next < number:
            if not self._capture.grab():
                self._count = self._next
                return None
            self._next += 1
        there, pixels = self._capture.read()
        if not there:
            self._count = self._next
            return None
        self._next += 1
        return np.asarray(pixels, np.uint8)

    @property
    def count(self) -> int:
        return self._count

    def close(self) -> None:
        self._capture.release()

    def _open(self) -> cv2.VideoCapture:
        # One thread: several robots share few cores.
        capture = cv2.VideoCapture(str(self._path), cv2.CAP_FFMPEG, [cv2.CAP_PROP_N_THREADS, 1])
        if not capture.isOpened() or not capture.get(cv2.CAP_PROP_FRAME_WIDTH):
            raise SourceError(f"'{self._path}': not a readable video; is it whole, and of a known format?")
        return capture


class Endless:
    """Recorded pictures that begin again after the last one."""

    def __init__(self, pictures: Recorded) -> None:
        self._pictures = pictures

    def picture(self, number: int) -> Picture | None:
        if self._pictures.count:
            number %= self._pictures.count
        found = self._pictures.picture(number)
        return found if found is not None or not self._pictures.count else self.picture(number)

    @property
    def count(self) -> int:
        return 0

    def close(self) -> None:
        self._pictures.close()


def _is_picture(file: Path) -> bool:
    """Returns whether a file seems to be a picture; hidden files beside pictures hold other data of theirs."""
    return file.suffix.lower() in PICTURES and not file.name.startswith(".") and file.is_file()


def _natural(name: str) -> list[tuple[int, str]]:
    """Returns a sort key that compares the numbers in names as numbers."""
    return [(int(part), "") if part.isdecimal() else (-1, part) for part in re.split(r"(\d+)", name)]
