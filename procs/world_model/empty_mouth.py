"""The own mouth while the light barrier sees no ball in it: what the camera shows there may be another thing."""

import math

from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import ball_percept_t

_IN_MOUTH_M = 0.05  # a ball that the camera shows this near to the place of a held one seems to be held


class EmptyMouth:
    """Decides whether camera and light barrier contradict each other about a ball in the own mouth."""

    def __init__(self) -> None:
        self._since_us: int | None = None  # first reading without a ball since the last one with a ball
        self._until_us = 0  # newest reading
        self._shown = False

    def note(self, kicker: kicker_state_t) -> None:
        """Takes the newest state of the own kicker."""
        self._until_us = kicker.capture_us or kicker.header.time_us
        if kicker.ball_held:
            self._since_us = None
        elif self._since_us is None:
            self._since_us = self._until_us

    def refutes(self, percept: ball_percept_t, exposed_us: int, mouth_m: float) -> bool:
        """Returns whether the ball of a frame is none; call it for each frame of the own camera.

        The second frame in a row that shows a ball in the empty mouth is believed: the light barrier may be broken.

        Args:
            percept: of the frame.
            exposed_us: its exposure.
            mouth_m: distance from the robot's middle to that of a held ball.
        """
        empty = self._since_us is not None and self._since_us <= exposed_us <= self._until_us
        before, self._shown = self._shown, empty and _is_in_mouth(percept, mouth_m)
        return self._shown and not before


def _is_in_mouth(percept: ball_percept_t, mouth_m: float) -> bool:
    return percept.visible and math.hypot(percept.x_m - mouth_m, percept.y_m) < _IN_MOUTH_M
