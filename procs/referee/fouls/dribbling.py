"""Dribbling: a robot may take the ball along for 3 m, then it must set it free (2019)."""

import math

from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason


def dribbling(scene: Scene) -> Foul | None:
    """Returns the foul of a robot that has carried the ball too far from where it took it."""
    carrier, ball = scene.carrier, scene.sight.ball
    if not carrier.robot or math.dist(carrier.since, ball) <= scene.rules.dribbling_m:
        return None
    return Foul(carrier.robot, Reason.DRIBBLING, ball)
