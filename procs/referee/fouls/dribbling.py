"""Dribbling: a robot may take the ball along for 3 m, then it must set it free (2019)."""

import math

from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason


def dribbling(scene: Scene) -> Foul | None:
    """Returns the foul of a robot that touches the ball too far from where it took it.

    A ball that rolls on by itself is set free.
    """
    robot = scene.carrier.robot
    place = scene.sight.touching.get(robot) if robot else None
    if place is None or math.dist(scene.carrier.since, place) <= scene.rules.dribbling_m:
        return None
    return Foul(robot, Reason.DRIBBLING, place)
