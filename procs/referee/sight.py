"""Observations of the referee and the assistants in a tick."""

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import NamedTuple

from procs.model.events import Event, Kind
from procs.model.field import SIDES, Field, Point
from procs.model.robot import number_of
from procs.model.teams import Team, team_number

LEAVES = frozenset({Kind.GOAL, Kind.OUT_SIDE, Kind.OUT_END})
"""Events of a ball that has left the field, whether a robot touched it last or none."""

_NOTHING: Mapping[str, Point] = MappingProxyType({})


class Sight(NamedTuple):
    """Ball, robots and events of a tick; world frame."""

    ball: Point
    events: Sequence[Event] = ()
    robots: Mapping[str, Point] = _NOTHING
    """Middle of each robot on the field."""
    velocities_m_s: Mapping[str, Point] = _NOTHING
    """Velocity of each robot; a robot that is missing stands still."""
    last_touch: str = ""
    """Robot that touched the ball last, in this tick or before."""
    bystander: str = ""
    """Robot that takes no part in the game and touched the ball in this tick, last of all; empty without one."""

    def without(self, robots: frozenset[str], shooter: str = "") -> "Sight":
        """Returns the sight without robots that take no part in the game, and without their events.

        A ball that leaves the field off one of them has left it off no robot, except off the `shooter`: that one played
        the ball while it took part, and no robot has touched the ball since.
        """
        if not robots:
            return self
        bystander = next(reversed(self.touching), "")
        if bystander not in robots:
            bystander = ""
        nobodys = robots if bystander else robots - {shooter}
        return self._replace(
            bystander=bystander,
            robots={name: place for name, place in self.robots.items() if name not in robots},
            events=[
                event._replace(robot="") if event.robot in nobodys else event
                for event in self.events
                if event.kind in LEAVES or robots.isdisjoint((event.robot, event.other))
            ],
            last_touch="" if self.last_touch in robots else self.last_touch,
        )

    @property
    def touching(self) -> dict[str, Point]:
        """Robots that touched, held or kicked the ball in this tick, and where it was, by name; the last one last."""
        events = sorted(self.events, key=lambda event: (event.robot == self.last_touch, event))
        return {each.robot: Point(each.x_m, each.y_m) for each in events if each.kind in (Kind.TOUCH, Kind.KICK)}

    def team(self, team: Team) -> list[str]:
        """Returns the robots of a team on the field, in the order of their numbers."""
        return sorted(
            (name for name in self.robots if team_number(name) is team), key=lambda name: (number_of(name), name)
        )

    def mates(self, robot: str) -> list[str]:
        """Returns the mates of a robot on the field."""
        return [name for name in self.team(team_number(robot)) if name != robot]

    def goalkeeper(self, team: Team) -> str:
        """Returns the goalkeeper of a team, the robot with the lowest number; empty for a robot that is alone."""
        robots = self.team(team)
        return robots[0] if len(robots) > 1 else ""


def left_unseen(ball: Point, last_touch: str, field: Field, ball_radius_m: float) -> Event:
    """Returns the event of a ball that lies outside the field, and left it while there was no referee."""
    if any(field.in_goal(*ball, side, ball_radius_m) for side in SIDES):
        kind = Kind.GOAL
    else:
        kind = Kind.OUT_SIDE if abs(ball.y_m) > field.half_width_m + ball_radius_m else Kind.OUT_END
    return Event(kind, last_touch, "", *ball, 0.0)
