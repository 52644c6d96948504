"""Limits of the skills: places where a robot or the ball can be, and speeds that robot or kicker reach."""

from lcmtypes.soccer import skill_command_t
from procs.behaviour.ballistics import hardest_kick_m_s, kick_speed_m_s
from procs.behaviour.bodies import Bodies
from procs.behaviour.obstacles import is_in_goal, reachable
from procs.model.field import Field, Point
from procs.model.geometry import BOUND, clamp, plausible

_DRIVES = ("goto", "dribble")
"""The robot's middle goes to the place."""
_AT_PLACE = ("mark", "block", "search", "aim", "pass", "push")
"""The skill is about something at the place. The others only kick in its direction, or find the ball themselves."""
_ROLLS = ("pass", "push")
"""The speed is that of the ball when it arrives."""
_ROUNDING_M = 1e-6


def accepted_place(skill: str, place: Point, field: Field, bodies: Bodies) -> Point:
    """Returns the place, or the nearest one that the skill accepts; one of senseless numbers stays, for `mistake`."""
    if skill not in (*_DRIVES, *_AT_PLACE) or not plausible(*place):
        return place
    x_m, y_m = _furthest_m(skill, field, bodies)
    if skill in _DRIVES and is_in_goal(place, field):
        place = reachable(place, field, bodies)
    return Point(clamp(place.x_m, -x_m, x_m), clamp(place.y_m, -y_m, y_m))


def mistake(command: skill_command_t, field: Field, bodies: Bodies) -> str:
    """Returns why the command of a known skill cannot be carried out, and what could be; empty if it can."""
    for name in ("x_m", "y_m", "heading_rad", "speed_m_s"):
        if not plausible(value := getattr(command, name)):
            return f"{name} is {value:g}; it should be a number between {-BOUND:g} and {BOUND:g}"
    if command.skill in _DRIVES and (reason := _in_goal(Point(command.x_m, command.y_m), field, bodies)):
        return reason
    place = accepted_place(command.skill, Point(command.x_m, command.y_m), field, bodies)
    furthest_m = _furthest_m(command.skill, field, bodies)
    wanted = (("x_m", command.x_m, place.x_m, furthest_m[0]), ("y_m", command.y_m, place.y_m, furthest_m[1]))
    for name, value_m, accepted_m, limit_m in wanted:
        if abs(value_m - accepted_m) > _ROUNDING_M:
            what = "a robot's middle" if command.skill in _DRIVES else "the place"
            return f"{name} is {value_m:g}; between the walls {what} can be from {-limit_m:g} to {limit_m:g}"
    if command.speed_m_s < 0.0:
        return f"speed_m_s is {command.speed_m_s:g}; it should be above 0, or 0 for the skill's own speed"
    hardest_m_s, kick_m_s = hardest_kick_m_s(bodies), kick_speed_m_s(0.0, command.speed_m_s, bodies)
    if command.skill in _ROLLS and kick_m_s > hardest_m_s:
        fastest_m_s = hardest_m_s * command.speed_m_s / kick_m_s
        return f"speed_m_s is {command.speed_m_s:g}; after the hardest kick the ball rolls at {fastest_m_s:.1f} at most"
    return ""


def _in_goal(place: Point, field: Field, bodies: Bodies) -> str:
    """Returns that a place is in or behind a goal, where no robot stands, and what would do; empty if it is not."""
    if not is_in_goal(place, field) or abs(place.x_m) > _furthest_m(_DRIVES[0], field, bodies)[0]:
        return ""
    where = "in" if abs(place.x_m) < field.half_length_m + field.goal_depth_m else "behind"
    limit_m = reachable(Point(field.half_length_m, place.y_m), field, bodies).x_m
    return f"({place.x_m:g}, {place.y_m:g}) is {where} a goal; at that y_m x_m can be from {-limit_m:g} to {limit_m:g}"


def _furthest_m(skill: str, field: Field, bodies: Bodies) -> tuple[float, float]:
    """Returns the largest coordinates between the walls that the skill accepts."""
    off_m = bodies.robot_radius_m if skill in _DRIVES else 0.0
    return field.half_length_m + field.border_m - off_m, field.half_width_m + field.border_m - off_m
