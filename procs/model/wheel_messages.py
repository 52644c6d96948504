"""Reads wheel speeds from messages, which may state a different number of wheels than the robot has."""

from collections.abc import Callable, Sequence

from procs.model.kinematics import WHEEL_ANGLES_DEG, Wheels


class WheelReader:
    """Reads the wheels of one channel; reports each wrong number of wheels once, not in every tick."""

    def __init__(self, channel: str, consequence: str, complain: Callable[[str], None]) -> None:
        """Begins without a report.

        Args:
            channel: name of the channel, for the report.
            consequence: what happens to a message with a wrong number of wheels, such as "ignored".
            complain: takes the text of the report.
        """
        self._channel = channel
        self._consequence = consequence
        self._complain = complain
        self._told = len(WHEEL_ANGLES_DEG)

    def read(self, values: Sequence[float], writer: str) -> Wheels | None:
        """Returns the values of a message, one for each wheel; None if there are more or fewer values than wheels."""
        count = len(WHEEL_ANGLES_DEG)
        if len(values) == count:
            first, second, third = values
            return first, second, third
        if len(values) != self._told:
            self._told = len(values)
            angles = ", ".join(map(str, WHEEL_ANGLES_DEG))
            self._complain(
                f"{self._channel} of {writer or 'an unknown writer'} has {len(values)} wheel speeds; this robot has "
                f"{count} wheels, at {angles} degrees from forward, and needs one speed for each, in this order; "
                f"{self._consequence}"
            )
        return None
