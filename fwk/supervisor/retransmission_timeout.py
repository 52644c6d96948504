"""The time after which a tick that is not answered is sent again."""

_MARGIN_US = 100
_AT_FIRST_US = 20_000


class RetransmissionTimeout:
    """Learns the usual duration of a stage, as TCP learns round trips (RFC 6298): smoothed time and deviation."""

    def __init__(self) -> None:
        self._usual_us = _AT_FIRST_US
        self._deviation_us = _AT_FIRST_US // 4

    @property
    def wait_us(self) -> int:
        """Wall time after which an unanswered tick is probably lost, in microseconds."""
        return self._usual_us + 3 * self._deviation_us + _MARGIN_US

    def took(self, duration_us: int) -> None:
        """Learns from a stage that was answered this long after its tick was sent."""
        error_us = duration_us - self._usual_us
        self._usual_us += error_us // 8
        self._deviation_us += (abs(error_us) - self._deviation_us) // 4
