"""All bodies of the physics engine at once: one call reads their states, another one sets their forces."""

import struct
from array import array

import pymunk
from pymunk import batch

_STATE_FIELDS = (
    batch.BodyFields.POSITION | batch.BodyFields.ANGLE | batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
)
_FORCE_FIELDS = batch.BodyFields.FORCE | batch.BodyFields.TORQUE
_NUMBERS = 3  # of a force and a torque
_STATE = struct.Struct("6d")

State = tuple[float, float, float, float, float, float]
"""Position x and y in m, angle in rad, velocity x and y in m/s and turning in rad/s of a body, world frame."""


class Bodies:
    """The moving bodies of a space, in the order in which they were added; no body may be added later."""

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._count = len(space.bodies)
        self._numbers, self._read = array("d", bytes(2 * _STATE.size * (self._count + 1))), batch.Buffer()
        self._read.set_float_buf(self._numbers)  # twice as long as needed, so that the engine never makes a longer one
        self._moving = memoryview(self._numbers).cast("B")[: _STATE.size * self._count]
        # The engine comes last to the body of all static shapes, which no force moves.
        self._forces = array("d", [0.0] * _NUMBERS * (self._count + 1))
        self._written = batch.Buffer()
        self._written.set_float_buf(self._forces)
        self._effects = struct.Struct(f"{_NUMBERS * self._count}d")

    def states(self) -> list[State]:
        """Returns the states of all bodies."""
        self._read.clear()
        batch.get_space_bodies(self._space, _STATE_FIELDS, self._read)
        return list(_STATE.iter_unpack(self._moving))

    def push(self, effects: list[float]) -> None:
        """Sets force (x and y in N, world frame) and torque (Nm) of each body for the coming step, body by body."""
        self._effects.pack_into(self._forces, 0, *effects)
        batch.set_space_bodies(self._space, _FORCE_FIELDS, self._written)
