import pymunk
import pytest

from procs.simulation.physics.bodies import Bodies


def space_of(*bodies: pymunk.Body) -> pymunk.Space:
    space = pymunk.Space()
    space.add(pymunk.Segment(space.static_body, (-1, -1), (1, -1), 0.1))
    for body in bodies:
        space.add(body, pymunk.Circle(body, 0.1))
    return space


def test_states_are_in_the_order_of_the_bodies() -> None:
    first, second = pymunk.Body(1.0, 1.0), pymunk.Body(2.0, 1.0)
    first.position, first.angle, first.velocity, first.angular_velocity = (1.0, 2.0), 0.5, (3.0, 4.0), 0.25
    second.position = (5.0, 6.0)
    bodies = Bodies(space_of(first, second))
    assert bodies.states() == [(1.0, 2.0, 0.5, 3.0, 4.0, 0.25), (5.0, 6.0, 0.0, 0.0, 0.0, 0.0)]


def test_each_body_is_pushed_with_its_own_force() -> None:
    first, second = pymunk.Body(1.0, 1.0), pymunk.Body(2.0, 1.0)
    first.position, second.position = (0.0, 0.0), (5.0, 0.0)
    space = space_of(first, second)
    bodies = Bodies(space)
    for _ in range(2):  # the engine forgets forces after each step
        bodies.push([1.0, 0.0, 0.0, 0.0, 4.0, 0.5])
        space.step(0.1)
    assert bodies.states()[0][3:] == pytest.approx((0.2, 0.0, 0.0))
    assert bodies.states()[1][3:] == pytest.approx((0.0, 0.4, 0.1))
