"""Notices that hardware has fallen silent, so that its last reading does not count for ever."""

from collections.abc import Callable

from fwk import Clock

_LONGEST_S = 0.5  # a reading counts for so long, or until the next iteration of its driver


class Silence:
    """Silence of one piece of hardware; hardware that has never spoken is not silent, but not there yet."""

    def __init__(self, warning: str, warn: Callable[[str], None]) -> None:
        """`warning` is a text with a place for `silent_s`, which `warn` tells once in each silence."""
        self.is_long = False
        """Whether the last reading does not count any more."""
        self._warning = warning
        self._warn = warn
        self._heard_us: int | None = None

    def end(self, clock: Clock) -> None:
        """Takes note of a reading."""
        self._heard_us, self.is_long = clock.now_us, False

    def go_on(self, clock: Clock) -> None:
        """Takes note of an iteration, after the readings of this iteration."""
        if self.is_long or self._heard_us is None:
            return
        silent_s = clock.since_s(self._heard_us)
        if silent_s > max(_LONGEST_S, clock.iteration_s):
            self.is_long = True
            self._warn(self._warning.format(silent_s=silent_s))
