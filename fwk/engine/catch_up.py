"""The catch-up rule: a component that joins a run sees only the newest message of each channel."""

import sys

AWAY_TICKS = 16
"""Writers keep messages for so many ticks; a component that took no part for longer joins again."""


class CatchUp:
    """Decides whether the next iteration of a component, or of a host, joins the run or follows an absence.

    The first incarnation of a component joins before tick 1 and sees everything. Every later incarnation catches up,
    and so does a component that took no part for more than `AWAY_TICKS` ticks. A continuous component is never
    absent: its host takes in messages between its iterations.
    """

    def __init__(self, incarnation: int = 1, continuous: bool = False) -> None:
        self._last = 1 if incarnation == 1 else 0  # the last tick that sees everything
        self._away_ticks = sys.maxsize if continuous else AWAY_TICKS

    def applies(self, tick: int) -> bool:
        """Returns whether an iteration of this tick sees the newest messages only."""
        return tick > self._last

    def takes_part(self, tick: int) -> bool:
        """Notes an iteration of this tick; returns whether it sees the newest messages only."""
        applies = tick > self._last
        self._last = tick + self._away_ticks
        return applies

    def took_part(self, tick: int) -> None:
        """Notes an iteration."""
        self._last = tick + self._away_ticks
