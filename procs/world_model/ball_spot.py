"""Position of the ball on the field by the camera alone, through the tree of frames at the time of the sighting."""

import numpy as np

from fwk import Component, Logger, Reads, TransformError, Transforms, Writes
from lcmtypes.robot import point_t
from lcmtypes.soccer import ball_percept_t

_WORLD = "world"


class BallSpot(Component):
    """Shows how well camera and localization agree; no other component reads its output."""

    stage = "think"
    ball_percept: Reads[ball_percept_t]
    tf: Transforms
    ball_spot: Writes[point_t]
    """The ball's lowest point in the world frame; written only when the ball is seen and the pose is known."""
    log: Logger

    def init(self) -> None:
        self._trouble = ""

    def loop(self) -> None:
        percept, spot = self.ball_percept.value, self.ball_spot.value
        if not (self.ball_percept.refreshed and percept.visible):
            return
        spot.capture_us = percept.capture_us or self.ball_percept.header.time_us
        try:
            to_world = self.tf.lookup(_WORLD, "base", spot.capture_us)
        except TransformError as error:
            self._tell(error)
            return
        self._trouble = ""
        spot.frame = _WORLD
        spot.x_m, spot.y_m, spot.z_m = to_world.apply(np.array([percept.x_m, percept.y_m, percept.z_m])).tolist()
        self.ball_spot.write()

    def _tell(self, error: TransformError) -> None:
        """Logs each kind of failure once, until it is over."""
        kind = type(error).__name__
        if kind != self._trouble:
            self.log.warning(f"no spot of the ball: {error}")
        self._trouble = kind
