"""Position of the ball on the field by the camera alone, through the tree of frames at the time of the sighting."""

import numpy as np

from fwk import Component, Logger, Reads, TransformError, Transforms, Writes
from lcmtypes.soccer import ball_percept_t, ball_spot_t


class BallSpot(Component):
    """Shows how well camera and localization agree; no other component reads its output."""

    stage = "think"
    ball_percept: Reads[ball_percept_t]
    tf: Transforms
    ball_spot: Writes[ball_spot_t]
    log: Logger

    def init(self) -> None:
        self._trouble = ""

    def loop(self) -> None:
        if not self.ball_percept.refreshed:
            return
        percept, spot = self.ball_percept.value, self.ball_spot.value
        spot.visible = False
        if percept.visible:
            try:
                to_world = self.tf.lookup("world", "base", self.ball_percept.header.time_us)
                spot.x_m, spot.y_m = to_world.apply(np.array([percept.x_m, percept.y_m, 0.0]))[:2].tolist()
                spot.visible = True
                self._trouble = ""
            except TransformError as error:
                self._tell(error)
        self.ball_spot.write()

    def _tell(self, error: TransformError) -> None:
        """Logs each kind of failure once, until it is over."""
        kind = type(error).__name__
        if kind != self._trouble:
            self.log.warning(f"no spot of the ball: {error}")
        self._trouble = kind
