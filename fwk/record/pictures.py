"""Pictures of cameras in a recording, as components like procs.pictures write them."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from fwk import messages
from fwk.record.log import LogReader
from lcmtypes.robot import picture_t

LOSSLESS = "png"
_FINGERPRINT = messages.fingerprint(picture_t)


@dataclass(frozen=True)
class RecordedPicture:
    """A picture, still compressed."""

    camera: str
    """Channel of the camera's frames."""
    frame: int
    tick: int
    time_us: int
    format: str
    data: bytes

    def pixels(self) -> NDArray[np.uint8] | None:
        """Height x width (x 3, blue green red); None if the data are damaged."""
        try:
            found = cv2.imdecode(np.frombuffer(self.data, np.uint8), cv2.IMREAD_UNCHANGED) if self.data else None
        except cv2.error:  # a picture that says it is larger than any
            return None
        return None if found is None else np.asarray(found, np.uint8)


def picture_of(data: bytes) -> RecordedPicture | None:
    """The picture that a message is; None if it is none."""
    if data[:8] != _FINGERPRINT:
        return None
    try:
        made: picture_t = messages.decode(picture_t, data, "")
    except messages.MessageError:
        return None
    header = made.header
    return RecordedPicture(made.camera, made.frame, header.tick, header.time_us, made.format, bytes(made.data))


def pictures_in(log: Path) -> Iterator[RecordedPicture]:
    """All pictures of a log, in its order.

    Raises:
        LogError: it cannot be read.
    """
    for event in LogReader(log):
        picture = picture_of(event.data)
        if picture:
            yield picture
