"""Areas: one field player of a team, for 10 s at most, in a penalty area; only its goalkeeper in a goal area (2016).

In the opponents' areas a goalkeeper is a field player. A robot that is alone keeps its own goal, too. A robot that has
crossed the goal line is still in the areas before it, also in the goal, until all of it is beside the goal and outside.
"""

from procs.model.field import SIDES, Point
from procs.model.geometry import clamp
from procs.model.teams import Team, team_number
from procs.referee.fouls.foul import Foul, Scene
from procs.referee.reasons import Reason


class Areas:
    """Counts how long the field players have been in the areas."""

    def __init__(self) -> None:
        self._inside_s: dict[str, float] = {}
        self._forbidden_s: dict[str, float] = {}

    def watch(self, scene: Scene) -> list[Foul]:
        """Returns the fouls of robots that have been where they may not for too long, one of each team at most."""
        places = {name: _on_field(scene, place) for name, place in sorted(scene.sight.robots.items())}
        field = scene.rules.field
        keepers = {side: next(iter(scene.sight.team(scene.ends.defender(side))), "") for side in SIDES}
        inside = {
            name: side
            for name, place in places.items()
            for side in SIDES
            if name != keepers[side] and field.in_penalty_area(*place, side)
        }
        self._inside_s = {name: self._inside_s.get(name, 0.0) + scene.duration_s for name in inside}
        in_goal_area = {name for name in inside if any(field.in_goal_area(*places[name], side) for side in SIDES)}
        forbidden = [name for name in inside if name in in_goal_area or self._is_second(name, inside)]
        self._forbidden_s = {name: self._forbidden_s.get(name, 0.0) + scene.duration_s for name in forbidden}
        found: dict[Team, Foul] = {}
        for name in [name for name, time_s in self._forbidden_s.items() if time_s > scene.rules.grace_s]:
            if team_number(name) not in found:
                del self._forbidden_s[name]
                reason = Reason.IN_GOAL_AREA if name in in_goal_area else Reason.TOO_MANY_IN_AREA
                found[team_number(name)] = Foul(name, reason, scene.sight.robots[name])
        for name in [name for name, time_s in self._inside_s.items() if time_s > scene.rules.area_s]:
            if team_number(name) not in found:
                self._inside_s[name] = 0.0
                found[team_number(name)] = Foul(name, Reason.TOO_LONG_IN_AREA, scene.sight.robots[name])
        return list(found.values())

    def _is_second(self, name: str, inside: dict[str, float]) -> bool:
        """Returns whether a mate has been in the same area for longer."""
        team, entered = team_number(name), (-self._inside_s[name], name)
        mates = [each for each in inside if inside[each] == inside[name] and team_number(each) is team]
        return any((-self._inside_s[each], each) < entered for each in mates)


def _on_field(scene: Scene, place: Point) -> Point:
    """Returns the middle of a robot, or the place on the goal line before it if it is in a goal or partly outside."""
    field = scene.rules.field
    in_goal = any(field.in_goal(*place, side) for side in SIDES)
    if not in_goal and abs(place.x_m) > field.half_length_m + scene.rules.robot.radius_m:
        return place
    return place._replace(x_m=clamp(place.x_m, -field.half_length_m, field.half_length_m))
