"""Static bodies: the low wall around the field, and the goals with posts and nets."""

import pymunk

from procs.model.field import SIDES, Field, Point
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
_NET_RADIUS_M = 0.02


def build_arena(space: pymunk.Space, field: Field, contacts: ContactSettings) -> None:
    """Adds the static shapes of a field to the space. The ball's own bounce is 1, so theirs is the bounce of a pair."""
    friction = contacts.wall_friction

    def add(shape: pymunk.Shape, bounce: float, meets: pymunk.ShapeFilter) -> None:
        shape.collision_type, shape.filter = WALL, meets
        shape.elasticity, shape.friction = bounce, friction
        space.add(shape)

    def add_net(start: Point, end: Point) -> None:
        add(pymunk.Segment(space.static_body, start, end, _NET_RADIUS_M), contacts.net_bounce, GOAL_FILTER)

    x_m = field.half_length_m + field.border_m + _WALL_RADIUS_M
    y_m = field.half_width_m + field.border_m + _WALL_RADIUS_M
    corners = [Point(-x_m, -y_m), Point(x_m, -y_m), Point(x_m, y_m), Point(-x_m, y_m)]
    for start, end in zip(corners, corners[1:] + corners[:1], strict=True):
        add(pymunk.Segment(space.static_body, start, end, _WALL_RADIUS_M), contacts.wall_bounce, WALL_FILTER)
    for side in SIDES:
        posts = field.goal_posts(side)
        back_m = side * (field.half_length_m + field.goal_depth_m + _NET_RADIUS_M)
        for post in posts:
            add(pymunk.Circle(space.static_body, field.post_diameter_m / 2, post), contacts.post_bounce, GOAL_FILTER)
            add_net(post, Point(back_m, post.y_m))
        add_net(Point(back_m, posts[0].y_m), Point(back_m, posts[1].y_m))
