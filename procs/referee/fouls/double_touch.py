"""Double touch: the taker of a set piece may not play the ball again before another robot has (2016, laws 8 to 17)."""

from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason


def double_touch(scene: Scene) -> Foul | None:
    """Returns the foul of a taker that played the ball twice; a robot without mates may."""
    touches = scene.touches
    if not touches.double:
        return None
    return Foul(touches.taker, Reason.DOUBLE_TOUCH, touches.place)
