"""Live pictures from a device of this machine or a network stream, read in a separate thread."""

import os
import stat
import threading
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np

from procs.drivers.recorded_pictures import SourceError
from procs.vision.colours import Picture

DEVICES = Path("/dev")
OPEN_TIMEOUT_MS = 5000
READ_TIMEOUT_MS = 2000
CLOSE_S = 1.0
"""Longest wait for the thread of a source that is closed."""


@dataclass(frozen=True)
class Wanted:
    """Format requested of a device; 0: the device's own. A device may ignore it."""

    width_px: int = 0
    height_px: int = 0
    rate_hz: float = 0.0


@dataclass(frozen=True)
class Backoff:
    """Waits before a lost source is opened again: the first, which doubles with each failure, and the longest."""

    first_s: float = 0.5
    longest_s: float = 10.0


def open_stream(url: str) -> cv2.VideoCapture:
    """Opens a stream: rtsp, http or any other that ffmpeg supports.

    Raises:
        SourceError: no pictures arrive from it.
    """
    limits = [cv2.CAP_PROP_OPEN_TIMEOUT_MSEC, OPEN_TIMEOUT_MS, cv2.CAP_PROP_READ_TIMEOUT_MSEC, READ_TIMEOUT_MS]
    capture = cv2.VideoCapture(url, cv2.CAP_FFMPEG, limits)
    if not capture.isOpened():
        raise SourceError(f"'{url}': no pictures arrive from it; is the camera running, and is the address right?")
    return capture


def open_device(path: Path, wanted: Wanted) -> cv2.VideoCapture:
    """Opens a Video4Linux device.

    Raises:
        SourceError: the device is missing, may not be used, or gives no pictures.
    """
    check_device(path)
    capture = cv2.VideoCapture(str(path), cv2.CAP_V4L2)
    if not capture.isOpened():
        raise SourceError(f"'{path}': it gives no pictures; does another program use it, or is it not a camera?")
    capture.set(cv2.CAP_PROP_BUFFERSIZE, 1)
    for what, value in (
        (cv2.CAP_PROP_FRAME_WIDTH, wanted.width_px),
        (cv2.CAP_PROP_FRAME_HEIGHT, wanted.height_px),
        (cv2.CAP_PROP_FPS, wanted.rate_hz),
    ):
        if value:
            capture.set(what, value)
    return capture


def check_device(path: Path) -> None:
    """Checks that the device exists and that this user may read it.

    Raises:
        SourceError: otherwise.
    """
    try:
        kind = path.stat().st_mode
    except OSError as error:
        there = ", ".join(str(each) for each in sorted(DEVICES.glob("video*"))) or "none"
        raise SourceError(f"'{path}': {error.strerror}; video devices of this machine: {there}") from error
    if not stat.S_ISCHR(kind):
        raise SourceError(f"'{path}': no such device")
    if not os.access(path, os.R_OK | os.W_OK):
        raise SourceError(f"'{path}': permission denied; on most systems users have to be in the group 'video'")


class Live:
    """Newest picture of a source that is read continuously, and opened again whenever it is lost."""

    def __init__(self, source: Callable[[], cv2.VideoCapture], backoff: Backoff) -> None:
        """Opens the source and begins to read.

        Args:
            source: opens the source.
            backoff: waiting times after the source was lost.

        Raises:
            SourceError: the source cannot be opened.
        """
        self._source = source
        self._backoff = backoff
        self._lock = threading.Lock()
        self._newest: Picture | None = None
        self._news: list[str] = []
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._work, args=(source(),), name="camera", daemon=True)
        self._thread.start()

    def picture(self) -> Picture | None:
        """Returns the newest picture since the last call, or None."""
        with self._lock:
            taken, self._newest = self._newest, None
        return taken

    def news(self) -> list[str]:
        """Returns the events since the last call: source lost, with the reason, or found again."""
        with self._lock:
            taken, self._news = self._news, []
        return taken

    def close(self) -> None:
        """Ends reading; abandons a source that hangs."""
        self._closing.set()
        self._thread.join(CLOSE_S)

    def _work(self, capture: cv2.VideoCapture | None) -> None:
        """Reads pictures in the separate thread until the source is closed."""
        while capture is not None:
            there, pixels = capture.read()
            if self._closing.is_set():
                capture.release()
                return
            if there:
                with self._lock:
                    self._newest = np.asarray(pixels, np.uint8)
            else:
                capture.release()
                self._tell("lost: it gives no more pictures; reopening it until it is back")
                capture = self._open_again()

    def _open_again(self) -> cv2.VideoCapture | None:
        """Retries until the source opens; returns None once the source is closed."""
        wait_s, said = self._backoff.first_s, ""
        while not self._closing.wait(wait_s):
            try:
                capture = self._source()
            except SourceError as error:
                if str(error) != said:
                    said = str(error)
                    self._tell(f"not back: {said}")
                wait_s = min(2 * wait_s, self._backoff.longest_s)
            else:
                self._tell("back")
                return capture
        return None

    def _tell(self, text: str) -> None:
        with self._lock:
            self._news.append(text)
