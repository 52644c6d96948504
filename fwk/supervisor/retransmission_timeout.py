"""How long the loop waits for answers before it takes a datagram for lost and tells a tick again."""

_MARGIN_US = 100
_AT_FIRST_US = 20_000


class Patience:
    """Learns how long a stage usually takes, as TCP learns round trips (RFC 6298): smoothed time and deviation."""

    def __init__(self) -> None:
        self._usual_us = _AT_FIRST_US
        self._deviation_us = _AT_FIRST_US // 4

    @property
    def wait_us(self) -> int:
        """No answer within this time: probably lost."""
        return self._usual_us + 3 * self._deviation_us + _MARGIN_US

    def took(self, duration_us: int) -> None:
        """All answers came within this time after the tick was told."""
        error_us = duration_us - self._usual_us
        self._usual_us += error_us // 8
        self._deviation_us += (abs(error_us) - self._deviation_us) // 4
