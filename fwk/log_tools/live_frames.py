"""Frames of the cameras of a run on this machine, read from the shared memory in which they are."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fwk.component.images import Ring, shape_of


class LiveFrames:
    """The rings of a run's cameras; each is opened when its first frame is wanted.

    Args:
        pid: the supervisor's process, which has all rings open.
    """

    def __init__(self, pid: int) -> None:
        self._pid = pid
        self._rings: dict[str, Ring] = {}

    def pixels(self, channel: str, announced: Any) -> NDArray[np.uint8] | None:
        """Returns the frame that a message announces, or the newest one if that has been overwritten.

        Args:
            channel: channel of the camera.
            announced: a `frame_t`.

        Returns:
            height x width (x channels); None, if there is no frame that this process may see.
        """
        ring = self._rings.get(channel)
        if ring is None:
            try:
                ring = Ring.of_process(self._pid, channel)
            except OSError:  # the run has ended, or belongs to another user
                return None
            if ring is None:
                return None
            self._rings[channel] = ring
        found = ring.get(announced.frame, announced.height_px * announced.width_px * announced.channels)
        if found is not None:
            return found.reshape(shape_of(announced.height_px, announced.width_px, announced.channels))
        newest = ring.newest()
        return newest[1] if newest else None
