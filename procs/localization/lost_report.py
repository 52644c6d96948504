"""Reports the reason for which a robot does not find its place, from the inputs of the lost robot."""

from collections.abc import Sequence

from procs.localization.hypotheses import Hypothesis
from procs.localization.self_localizer import LocalizerSettings

_PERIOD_S = 10.0  # from one report to the next; a robot usually finds its place within two seconds


class LostReport:
    """Counts the inputs of a lost robot for 10 s at a time."""

    def __init__(self) -> None:
        self._lost_s = 0.0
        self._begin()

    def _begin(self) -> None:
        self._period_s = 0.0
        self._messages = self._frames = self._headings = self._searches = 0
        self._ahead_s = 0.0

    def clear(self) -> None:
        """Forgets everything: the robot has found its place."""
        if self._lost_s:
            self._lost_s = 0.0
            self._begin()

    def count(self, duration_s: float, ahead_s: float | None, points: int, has_heading: bool, searched: bool) -> bool:
        """Counts the inputs of a tick; returns whether a report is due.

        Args:
            duration_s: time since the last tick.
            ahead_s: how far the exposure of a new message lies in the future; None without a new message.
            points: white points of the message that could be used.
            has_heading: whether there is a heading of the compass for them.
            searched: whether the robot has searched the field with them.
        """
        self._lost_s += duration_s
        self._period_s += duration_s
        if ahead_s is not None:
            self._messages += 1
            self._ahead_s = max(self._ahead_s, ahead_s)
        self._frames += points > 0
        self._headings += has_heading
        self._searches += searched
        return self._period_s >= _PERIOD_S

    def text(self, places: Sequence[Hypothesis], settings: LocalizerSettings) -> str:
        """Returns the reason in words and begins to count anew; `places` are the possible places, best first."""
        reason = self._reason(places, settings)
        self._begin()
        return f"has not found its place for {self._lost_s:.0f} s: {reason}"

    def _reason(self, places: Sequence[Hypothesis], settings: LocalizerSettings) -> str:
        if not self._messages:
            return "no message with line points came"
        if not self._frames and self._ahead_s > 0.0:
            return f"exposures lie up to {self._ahead_s:.3g} s in the future; check the clock of the camera"
        if not self._frames:
            return "no message had points of which the robot knows how it has moved since their exposure"
        if not self._headings:
            return "no heading of a compass came, and both halves of the field look alike"
        if not self._searches:
            return f"no frame had {settings.least_points} white points within {settings.reach_m:g} m"
        best = places[0]
        if best.score < settings.good_score:
            return (
                f"the best place, {_words(best)}, fits with a score of {best.score:.2f}, less than good_score,"
                f" {settings.good_score:g}; check compass, calibration and lighting of the camera"
            )
        if len(places) > 1:
            return f"two places fit alike: {_words(best)} and {_words(places[1])}; check the compass, or move the robot"
        return f"it has just seen the place {_words(best)}"


def _words(place: Hypothesis) -> str:
    x_m, y_m, heading_rad = place.pose
    return f"({x_m:.2f} m, {y_m:.2f} m, heading {heading_rad:.2f} rad)"
