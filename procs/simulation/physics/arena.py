"""Static bodies: the low wall around the field, and the goals with posts and nets."""

import pymunk

from procs.model.field import SIDES, Field, Point, Segment
from procs.simulation.physics.settings import ContactSettings

WALL, BALL, ROBOT, HULL = 1, 2, 3, 4
"""Collision types; a robot's round body meets everything but the ball, its hull with the mouth only the ball."""

_BALL_BIT, _SOLID_BIT, _HULL_BIT, _GOAL_BIT = 1, 2, 4, 8
WALL_FILTER = pymunk.ShapeFilter(categories=_SOLID_BIT)
GOAL_FILTER = pymunk.ShapeFilter(categories=_GOAL_BIT)
ROBOT_FILTER = pymunk.ShapeFilter(categories=_SOLID_BIT, mask=_SOLID_BIT | _GOAL_BIT)
HULL_FILTER = pymunk.ShapeFilter(categories=_HULL_BIT, mask=_BALL_BIT)
_BALL_FILTERS = {
    (over_robots, over_goals): pymunk.ShapeFilter(
        categories=_BALL_BIT, mask=_SOLID_BIT | (0 if over_robots else _HULL_BIT) | (0 if over_goals else _GOAL_BIT)
    )
    for over_robots in (False, True)
    for over_goals in (False, True)
}


def ball_filter(over_robots: bool = False, over_goals: bool = False) -> pymunk.ShapeFilter:
    """Returns what a ball at some height meets: always the walls, and what it does not fly over."""
    return _BALL_FILTERS[over_robots, over_goals]


_WALL_RADIUS_M = 0.05
NET_RADIUS_M = 0.02


def nets(field: Field, side: float) -> tuple[Segment, Segment, Segment]:
    """Returns the middles of the nets of a goal: those that begin at the posts, in their order, and the back."""
    first, second = field.goal_posts(side)
    back_m = side * (field.half_length_m + field.goal_depth_m + NET_RADIUS_M)
    corners = Point(back_m, first.y_m), Point(back_m, second.y_m)
    return Segment(first, corners[0]), Segment(second, corners[1]), Segment(*corners)


def build_arena(space: pymunk.Space, field: Field, contacts: ContactSettings) -> None:
    """Adds the static shapes of a field to the space. The ball's own bounce is 1, so theirs is the bounce of a pair."""
    friction = contacts.wall_friction

    def add(shape: pymunk.Shape, bounce: float, meets: pymunk.ShapeFilter) -> None:
        shape.collision_type, shape.filter = WALL, meets
        shape.elasticity, shape.friction = bounce, friction
        space.add(shape)

    def add_net(net: Segment) -> None:
        add(pymunk.Segment(space.static_body, net.start, net.end, NET_RADIUS_M), contacts.net_bounce, GOAL_FILTER)

    x_m = field.half_length_m + field.border_m + _WALL_RADIUS_M
    y_m = field.half_width_m + field.border_m + _WALL_RADIUS_M
    corners = [Point(-x_m, -y_m), Point(x_m, -y_m), Point(x_m, y_m), Point(-x_m, y_m)]
    for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
        add(pymunk.Segment(space.static_body, start, end, _WALL_RADIUS_M), contacts.wall_bounce, WALL_FILTER)
    for side in SIDES:
        *beside, back = nets(field, side)
        for post, net in zip(field.goal_posts(side), beside, strict=True):
            add(pymunk.Circle(space.static_body, field.post_diameter_m / 2, post), contacts.post_bounce, GOAL_FILTER)
            add_net(net)
        add_net(back)
