"""Times of exposures."""

from fwk import Image
from procs.model.units import US_PER_S


def captured_us(image: Image, latency_s: float) -> int:
    """Returns the logical time of the newest frame's exposure; 0 if it is not known.

    For a camera that does not state it, `latency_s` is the time from the exposure to the publication of the frame.
    """
    announced = image.announcement
    return announced.value.capture_us or max(0, announced.header.time_us - round(latency_s * US_PER_S))
