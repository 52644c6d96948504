"""Video encoders: codecs that browsers play, from the best library that is installed."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from importlib import import_module
from pathlib import Path
from typing import Any, Protocol

import cv2
import numpy as np
from numpy.typing import NDArray

Picture = NDArray[np.uint8]
"""Height x width x 3, blue green red; always the same size, both even."""

_FRAGMENTS = "frag_keyframe+empty_moov+default_base_moof"
"""An mp4 of fragments, each complete in itself: the file of a killed process plays up to the last one."""
_PYAV_CODECS = ("libx264", "libopenh264", "libvpx-vp9")
_OPENCV_OPTIONS = "deadline;realtime|cpu-used;8"
"""Fastest settings of VP9: the default takes seconds for a picture of a match."""
_OPENCV_CODECS = {"avc1": "H.264", "vp09": "VP9", "mp4v": "MPEG-4 part 2"}
_KEY_PICTURES = 40  # most pictures that are lost when the process is killed; OpenCV finishes a file only in `close`
_PLAYED_NOWHERE = "MPEG-4 part 2"


class EncoderError(Exception):
    """A video file cannot be written; the text names the file and the reason."""


class Encoder(Protocol):
    """Video file that is being written."""

    codec: str
    """Name of the codec, for people."""

    def write(self, picture: Picture) -> None:
        """Adds a picture."""
        ...

    def close(self) -> None:
        """Finishes the file."""
        ...


def advice(codec: str) -> str:
    """Returns advice about a codec that browsers do not play; empty for all others."""
    if codec != _PLAYED_NOWHERE:
        return ""
    return "browsers do not play MPEG-4 part 2; for H.264: pip install 'fwk[video]'"


def open_encoder(out: Path, pictures_per_s: float, width_px: int, height_px: int) -> Encoder:
    """Opens a video file for pictures of one size, with the first codec that works.

    Raises:
        EncoderError: the file cannot be written.
    """
    try:
        return PyavEncoder(out, pictures_per_s, width_px, height_px)
    except ImportError:
        return OpencvEncoder(out, pictures_per_s, width_px, height_px)


class PyavEncoder:
    """Writes H.264 or VP9 with PyAV.

    Raises:
        ImportError: PyAV is not installed, or has no codec that browsers play.
        EncoderError: the file cannot be written.
    """

    def __init__(self, out: Path, pictures_per_s: float, width_px: int, height_px: int) -> None:
        av: Any = import_module("av")
        self._av = av
        self._out = out
        name = next((each for each in _PYAV_CODECS if each in av.codecs_available and _encodes(av, each)), None)
        if name is None:
            raise ImportError("PyAV without a codec that browsers play")
        self.codec = "VP9" if "vp9" in name else "H.264"
        try:
            self._bytes = open(out, "wb")  # noqa: SIM115 - closed with the video; FFmpeg's own files hide a full disk
        except OSError as error:
            raise EncoderError(_unwritable(out)) from error
        self._file = av.open(self._bytes, "w", format="mp4", options={"movflags": _FRAGMENTS})
        self._stream = self._file.add_stream(name, rate=Fraction(pictures_per_s).limit_denominator(1000))
        self._stream.width, self._stream.height, self._stream.pix_fmt = width_px, height_px, "yuv420p"
        self._stream.codec_context.gop_size = _KEY_PICTURES
        self._stream.codec_context.max_b_frames = 0  # with them, players show every picture two pictures late

    def write(self, picture: Picture) -> None:
        """Adds a picture.

        Raises:
            EncoderError: the disk is full, for example.
        """
        with self._written():
            self._file.mux(self._stream.encode(self._av.VideoFrame.from_ndarray(picture, format="bgr24")))

    def close(self) -> None:
        """Finishes the file.

        Raises:
            EncoderError: the disk is full, for example.
        """
        with self._written():
            self._file.mux(self._stream.encode(None))
            self._file.close()
            self._bytes.close()

    @contextmanager
    def _written(self) -> Iterator[None]:
        try:
            yield
        except OSError as error:
            raise EncoderError(f"{self._out}: cannot be written: {error.strerror}") from error


class OpencvEncoder:
    """Writes what this build of OpenCV can: H.264, else VP9, else MPEG-4 part 2.

    Raises:
        EncoderError: the file cannot be written.
    """

    def __init__(self, out: Path, pictures_per_s: float, width_px: int, height_px: int) -> None:
        self._out = out
        self._pictures = 0
        with _quiet():
            for word, codec in _OPENCV_CODECS.items():
                fourcc = cv2.VideoWriter.fourcc(*word)
                self._writer = cv2.VideoWriter(str(out), cv2.CAP_FFMPEG, fourcc, pictures_per_s, (width_px, height_px))
                if self._writer.isOpened():
                    self.codec = codec
                    return
        raise EncoderError(_unwritable(out))

    def write(self, picture: Picture) -> None:
        """Adds a picture."""
        self._writer.write(picture)
        self._pictures += 1

    def close(self) -> None:
        """Finishes the file.

        Raises:
            EncoderError: pictures are missing in it, because the disk is full, for example.
        """
        self._writer.release()
        written = sum(1 for _ in _pictures_of(self._out))  # the writer itself reports nothing
        if written != self._pictures:
            raise EncoderError(
                f"{self._out}: cannot be written: {written} of {self._pictures} pictures are in it; is there room?"
            )


def _unwritable(out: Path) -> str:
    return f"{out}: cannot write a video there; check that the folder exists and can be written"


def _pictures_of(file: Path) -> Iterator[None]:
    reader = cv2.VideoCapture(str(file))
    while reader.grab():
        yield None


def _encodes(av: Any, name: str) -> bool:
    try:
        return bool(av.Codec(name, "w").is_encoder)
    except ValueError:
        return False


@contextmanager
def _quiet() -> Iterator[None]:
    """Keeps FFmpeg's complaints about missing codecs from stderr, and passes options to its encoders."""
    before = os.environ.get("OPENCV_FFMPEG_WRITER_OPTIONS")
    os.environ["OPENCV_FFMPEG_WRITER_OPTIONS"] = _OPENCV_OPTIONS
    stderr, null = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    os.dup2(null, 2)
    try:
        yield
    finally:
        os.dup2(stderr, 2)
        os.close(stderr)
        os.close(null)
        if before is None:
            del os.environ["OPENCV_FFMPEG_WRITER_OPTIONS"]
        else:
            os.environ["OPENCV_FFMPEG_WRITER_OPTIONS"] = before
