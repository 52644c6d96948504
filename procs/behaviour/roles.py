"""Assignment of roles: every robot computes the same from the knowledge of the team."""

import itertools
import math
from collections.abc import Container, Mapping, Sequence
from typing import NamedTuple

from procs.behaviour import ballistics
from procs.behaviour.game import Game
from procs.behaviour.passing import taken
from procs.behaviour.posts import PLAY, posts
from procs.behaviour.view import Ball, Robot, View
from procs.model.field import Field, Point
from procs.model.robot import ABSENT

GOALKEEPER, ATTACKER, SUPPORTER, DEFENDER = "goalkeeper", "attacker", "supporter", "defender"
PASSER = "passer"
"""Took a set piece and may not touch the ball before another robot has."""
ROLLS_M_S = 0.6
"""The nearest robot takes a slower ball, whatever was agreed."""
HAS_BALL_M = 0.09
"""Beside its body a robot has the ball."""

_STAY_S = 0.6  # an attacker keeps its role unless another is so much faster at the ball
_STAY_PRESSING_S = 0.3  # a second attacker stays until the team is so much sooner at the ball
_STAY_M = 1.0  # a robot keeps its role in the formation unless a change saves this much distance
_FEW = 5  # of so few robots all orders are tried
_AGREED_M = 20.0  # the same for a robot that has accepted a pass


class Job(NamedTuple):
    """A robot's part in the team."""

    role: str
    place: Point
    """Default place of the role."""


def assign(
    view: View,
    field: Field,
    presses: bool = False,
    game: Game = PLAY,
    goal_is_kept: bool = False,
    stalled: Container[str] = (),
) -> dict[str, Job]:
    """Jobs of the own robot, if it is localized, and of its mates, by name.

    The lowest number keeps the goal unless it is alone, and then at a penalty of the other team; no other does while
    that one is on the field and does not play, or if `goal_is_kept` by a mate without a radio, as field players may not
    stay in the areas. Of the others the receiver of a pass on its way attacks, else the robot that meets the ball
    first; `stalled` robots only if there is no other. A team that `presses` sends a second robot in play if an opponent
    is at the ball sooner. The rest fill the formation, at set pieces within the rules, so that they drive little. The
    order of the mates does not matter.
    """
    present = [robot for robot in (*view.mates, view.own) if robot is not view.own or view.localized]
    team = sorted((robot for robot in present if robot.role != ABSENT), key=lambda robot: robot.name)
    jobs: dict[str, Job] = {}
    if not goal_is_kept and (len(team) > 1 or (team and game.faces_penalty)):
        keeper = min(present, key=lambda robot: (robot.number, robot.name))
        if keeper in team:
            jobs[keeper.name] = Job(GOALKEEPER, field.goal_centre(-1.0))
            team.remove(keeper)
    if not team:
        return jobs
    course = ballistics.Course(view.ball, view.bodies)
    times_s = {robot.name: time_to_ball_s(robot, view.ball, course) for robot in team}
    attacker = receiver(team, view) or _first_at_ball(team, times_s, stalled)
    jobs[attacker.name] = Job(ATTACKER, view.ball.place)
    team.remove(attacker)
    theirs_s = opponents_time_s(view, course)
    ours = times_s[attacker.name] <= theirs_s
    pressing_s = _STAY_PRESSING_S if any(robot.role == ATTACKER for robot in team) else 0.0
    if presses and game.free_play and len(team) > 1 and theirs_s < times_s[attacker.name] + pressing_s:
        second = _first_at_ball(team, times_s, stalled)
        jobs[second.name] = Job(ATTACKER, view.ball.place)
        team.remove(second)
    supporter = next((robot for robot in team if robot.role == SUPPORTER), None)
    found = posts(len(team), view, field, game, ours, supporter)
    jobs.update(_fill(team, [Job(DEFENDER if number else SUPPORTER, post) for number, post in enumerate(found)]))
    return jobs


def _first_at_ball(team: Sequence[Robot], times_s: Mapping[str, float], stalled: Container[str]) -> Robot:
    """Returns the robot that meets the ball first; attackers keep their role unless another is much faster."""
    free = [robot for robot in team if robot.role != PASSER] or team
    free = [robot for robot in free if robot.name not in stalled] or free
    return min(free, key=lambda robot: (times_s[robot.name] - _STAY_S * (robot.role == ATTACKER), robot.name))


def receiver(team: Sequence[Robot], view: View) -> Robot | None:
    """Returns the robot of the team for which an agreed pass is on its way; None without one.

    The passer says that it has passed, so that noise of the ball's velocity does not count as a pass.
    """
    if view.ball.speed_m_s < ROLLS_M_S or taken(view):
        return None
    passers = {robot.name: robot for robot in (view.own, *view.mates) if robot.role == PASSER}
    for robot in team:
        passer = passers.get(robot.agreement.passer)
        if passer and passer.agreement.receiver == robot.name:
            return robot
    return None


def time_to_ball_s(robot: Robot, ball: Ball, course: ballistics.Course) -> float:
    """Returns the time in which a robot meets the ball; 0 for one that has it."""
    # A dribbling robot takes the ball along; a mate ahead of the ball would seem to meet it sooner.
    if math.dist(robot.place, ball.place) < course.bodies.beside_m + HAS_BALL_M:
        return 0.0
    return course.meet(robot.place, robot.velocity_m_s).time_s


def opponents_time_s(view: View, course: ballistics.Course) -> float:
    """Returns the time in which the first opponent meets the ball; infinity without opponents."""
    return min((course.meet(other.place, other.velocity_m_s).time_s for other in view.opponents), default=math.inf)


def _fill(team: Sequence[Robot], jobs: Sequence[Job]) -> dict[str, Job]:
    """Returns the job of each robot; there are at least as many jobs, and the most important ones are filled."""
    ways_m = [[_way_m(robot, job) for job in jobs] for robot in team]
    orders = itertools.permutations(range(len(team)))
    if len(team) <= _FEW:
        best = min(orders, key=lambda order: (_whole_m(ways_m, order), order))
    else:
        best = _exchanged(ways_m, next(orders))
    return {robot.name: jobs[index] for robot, index in zip(team, best, strict=True)}


def _exchanged(ways_m: Sequence[Sequence[float]], order: tuple[int, ...]) -> tuple[int, ...]:
    """Returns the order after all exchanges of two jobs that save way: a large team has too many orders to try all."""
    pairs = list(itertools.combinations(range(len(order)), 2))
    while True:
        others = [_with_exchange(order, *pair) for pair in pairs]
        best = min(others, key=lambda other: (_whole_m(ways_m, other), other))
        if _whole_m(ways_m, best) >= _whole_m(ways_m, order):
            return order
        order = best


def _with_exchange(order: tuple[int, ...], one: int, two: int) -> tuple[int, ...]:
    changed = list(order)
    changed[one], changed[two] = order[two], order[one]
    return tuple(changed)


def _whole_m(ways_m: Sequence[Sequence[float]], order: Sequence[int]) -> float:
    return sum(ways_m[number][index] for number, index in enumerate(order))


def _way_m(robot: Robot, job: Job) -> float:
    """Returns the distance from a robot to a job's place; less for a job of the robot's present role."""
    stay_m = _AGREED_M if robot.agreement.passer else _STAY_M
    return math.dist(robot.place, job.place) - stay_m * (robot.role == job.role)
