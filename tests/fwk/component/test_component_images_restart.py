"""A restarted camera publishes new frames, not those of its previous incarnation."""

import numpy as np

from fwk.clock import Clock
from fwk.component.channels import Reads, Writes
from fwk.component.images import Image, Ring, VisionMaster
from fwk.component.log import Logger
from lcmtypes.core import frame_t


def test_first_frame_of_a_restarted_camera_is_new() -> None:
    ring = Ring.create("camera")
    announcements = Reads("r/image", frame_t)
    image = Image(announcements, ring, Logger("r/finder", Clock(), print))
    sequence = 0
    for shade in (10, 20):  # each time a new process, which continues from the marks
        writer = Writes("r/image", frame_t)
        writer.sequence = sequence
        VisionMaster(writer, ring).publish(np.full((4, 4), shade, np.uint8))
        announcements._freeze(writer._take())
        sequence = writer.sequence
        assert image.pixels is not None
        assert (image.pixels == shade).all()
