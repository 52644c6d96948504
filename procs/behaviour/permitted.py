"""Places where a robot may stand: between the walls, in no goal, and for field players in no goal area."""

from collections.abc import Mapping

from lcmtypes.soccer import world_model_t
from procs.behaviour.bodies import Bodies
from procs.behaviour.company import rank_of
from procs.behaviour.goals import Goals
from procs.behaviour.obstacles import reachable
from procs.model.field import Field, Point
from procs.model.robot import ABSENT, Player, number_of_mate, number_of_player


def is_field_player(model: world_model_t, robot: str, players: Mapping[str, Player]) -> bool:
    """Returns whether the robot is a field player: a mate on the field has a lower number, and so keeps the goal.

    A robot that hears no mate, but sees some, is one unless it has the lowest number of all players. A robot that is
    alone may go everywhere.
    """
    number = number_of_player(robot, players)
    heard = [mate for mate in model.mates if mate.role != ABSENT]
    if model.silent_mates and not heard:
        return rank_of(robot, players) > 0
    return any(number_of_mate(mate, players) < number for mate in heard)


class Permitted:
    """Finds the place nearest to a target where a robot may stand; in the world frame or the attack frame."""

    def __init__(self, field: Field, bodies: Bodies) -> None:
        self._field, self._bodies = field, bodies
        self.goals = Goals(field, bodies)
        """The nets and areas that ways lead around."""

    def nearest(self, place: Point, field_player: bool) -> Point:
        """Returns the place, or the nearest permitted one; for a place in a goal, that is before the goal line."""
        place = reachable(place, self._field, self._bodies)
        return self.goals.outside_areas(place) if field_player else place
