"""A simple opponent, which is never improved: the nearest robot chases the ball and shoots; no roles, no passes."""

import math

from procs.behaviour import formation
from procs.behaviour.game import Game, Whose
from procs.behaviour.order import Order
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, PASSER
from procs.behaviour.view import Robot, View
from procs.model.field import Field, Point
from procs.model.geometry import bearing_rad, between, clamp
from procs.model.robot import ABSENT

_KEEPER, _TAKER = 1, 2  # ranks in the team
_TOUCHED_M = 0.14  # a robot with the ball so near to its body has touched it
_CLEAR_M = 0.5  # distance from the own penalty area
_PUSH = 0.2  # share of the way to the goal for which a robot that is alone pushes the ball ahead
_MIDDLE = 3.5  # mean of the ranks of the robots that do not have the ball, in the usual line-up
_INSIDE_M = 0.5  # distance of their places from the touch lines
# On the usual field; on others they are larger or smaller with it:
_SHOT_RANGE_M = 8.0
_BEHIND_M = 1.5  # distance along x between the robots that do not have the ball
_ASIDE_M = 0.8  # distance along y between those robots


def decide(view: View, game: Game, holds_ball: bool, field: Field) -> tuple[str, Order]:
    """Returns the role and the order of a robot, in the attack frame.

    The lowest number of the robots that play keeps the goal, the next one takes the set pieces; a robot that is alone
    plays, whatever its number, and keeps the goal at a penalty of the other team. In play the robot that believes
    itself nearest to the ball goes for it and shoots; the others line up behind it. A taker shoots from where it is,
    and leaves the ball alone until another robot is at it, if it has mates.
    """
    mates = _mates(view)
    rank, ball = _rank(view), view.ball.place
    if game.paused or not view.localized:
        return DEFENDER, Order("stop", intention="pause" if game.paused else "lost")
    alone = _is_alone(view)
    if game.faces_penalty if alone else rank == _KEEPER:
        return GOALKEEPER, Order("shoot", field.goal_centre(1.0)) if holds_ball else Order("keep_line")
    if not game.free_play:
        takes = (rank == _TAKER or alone) and game.whose is Whose.OURS
        return _set_piece(view, game, takes, holds_ball, field)
    touched = view.is_at_ball(view.others, _TOUCHED_M)
    taken = view.own.role == PASSER and bool(mates) and not touched
    if holds_ball and taken:
        return PASSER, Order("shoot", field.goal_centre(1.0), intention="take set piece")
    if holds_ball:
        return ATTACKER, _play(view, field)
    free = [robot for robot in mates if robot.role != PASSER]
    if not taken:
        free.append(view.own)
    nearest = min(free, key=lambda robot: (math.dist(robot.place, ball), robot.name), default=None)
    if view.ball.known and nearest is view.own:
        return ATTACKER, Order("get_ball", ball, bearing_rad(ball, field.goal_centre(1.0)), "chase")
    along, across = formation.scale(field)
    least_m = field.penalty_area_depth_m + _CLEAR_M - field.half_length_m
    aside_m = _ASIDE_M * across * (rank - _MIDDLE)
    widest_m = field.half_width_m - _INSIDE_M
    y_m = clamp(0.5 * ball.y_m + aside_m, -widest_m, widest_m)
    place = Point(max(ball.x_m - _BEHIND_M * along * rank, least_m), y_m)
    return PASSER if taken else DEFENDER, Order("goto", place, bearing_rad(place, ball), "follow")


def _mates(view: View) -> list[Robot]:
    """Returns the mates that play."""
    return [mate for mate in view.mates if mate.role != ABSENT]


def _rank(view: View) -> int:
    """Returns the place of the robot in the order of its team's numbers, from 1; its number if it hears no mate."""
    own, mates = (view.own.number, view.own.name), _mates(view)
    return 1 + sum((mate.number, mate.name) < own for mate in mates) if mates else view.own.number


def _is_alone(view: View) -> bool:
    return not (_mates(view) or view.silent_mates)


def _set_piece(view: View, game: Game, takes: bool, holds_ball: bool, field: Field) -> tuple[str, Order]:
    goal = field.goal_centre(1.0)
    goal_rad = bearing_rad(game.spot, goal)
    if not takes:
        along, _ = formation.scale(field)
        place = Point(game.spot.x_m - _BEHIND_M * along * _rank(view), 0.5 * game.spot.y_m)
        place = formation.allowed(place, game, field, view.bodies)
        step = formation.next_step(view.own.place, place, game, field, view.others, view.bodies)
        return DEFENDER, Order("goto", step, bearing_rad(step, game.spot), "keep distance")
    if holds_ball and _is_alone(view):
        return ATTACKER, _play(view, field)
    if game.stopped:
        return ATTACKER, Order("goto", formation.taker_place(game.spot, goal_rad), goal_rad, "take set piece")
    return PASSER, Order(
        "shoot" if holds_ball else "get_ball", goal if holds_ball else game.spot, goal_rad, "take set piece"
    )


def _play(view: View, field: Field) -> Order:
    goal, range_m = field.goal_centre(1.0), _SHOT_RANGE_M * formation.scale(field)[0]
    if math.dist(view.own.place, goal) < range_m:
        return Order("shoot", goal, bearing_rad(view.own.place, goal), "shoot")
    if _is_alone(view):  # all the way is too long for a dribble
        return Order("push", between(view.own.place, goal, _PUSH), bearing_rad(view.own.place, goal), "push")
    target = Point(field.half_length_m - range_m / 2, 0.0)
    return Order("dribble", target, bearing_rad(view.own.place, goal), "dribble")
