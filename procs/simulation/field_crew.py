"""Carries out what people and programs ask of the world: robots and ball are put down, the world stands still."""

import math

from fwk import Serves
from lcmtypes.soccer import freeze_world_t, place_ball_t, place_robot_t, reset_world_t
from procs.model.field import Field
from procs.simulation.physics.ball_body import THROW_LIMIT_M_S
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World


class FieldCrew:
    """Answers the commands of a tick, in the order: reset, robots, ball, freeze."""

    def __init__(self, world: World, field: Field) -> None:
        self.frozen = False
        """True while robots and ball stand still."""
        self._world = world
        self._x_m = field.half_length_m + field.border_m
        self._y_m = field.half_width_m + field.border_m

    def carry_out(
        self,
        place_robot: Serves[place_robot_t],
        place_ball: Serves[place_ball_t],
        freeze: Serves[freeze_world_t],
        reset: Serves[reset_world_t],
    ) -> None:
        """Takes all waiting commands."""
        for beginning in reset:
            self._world.return_to_starts()
            if beginning.value.keep_ball or self._world.place_ball(0.0, 0.0):
                beginning.done()
            else:
                beginning.fail(_NO_ROOM_FOR_BALL)
        for robot in place_robot:
            mistake = self._mistake_in_robot(robot.value)
            if mistake:
                robot.reject(mistake)
                continue
            wanted = robot.value
            if self._world.place_robot(wanted.robot, Pose(wanted.x_m, wanted.y_m, wanted.heading_rad)):
                robot.done()
            else:
                robot.reject(f"there is no room left for {wanted.robot} between the walls")
        for ball in place_ball:
            mistake = self._mistake_in_ball(ball.value)
            if mistake:
                ball.reject(mistake)
                continue
            throw = ball.value
            if not self._world.place_ball(throw.x_m, throw.y_m):
                ball.reject(_NO_ROOM_FOR_BALL)
                continue
            self._world.throw_ball(throw.z_m, (throw.vx_m_s, throw.vy_m_s, throw.vz_m_s))
            ball.done()
        for wish in freeze:
            self.frozen = bool(wish.value.frozen)
            if self.frozen:
                self._world.drop_kicks()
            wish.done()

    def _mistake_in_robot(self, wanted: place_robot_t) -> str:
        if wanted.robot not in self._world.robots:
            return f"no robot '{wanted.robot}'; there are: {', '.join(self._world.robots)}"
        if not math.isfinite(wanted.heading_rad):
            return f"heading_rad is {wanted.heading_rad}; it should be a number"
        return self._mistake_in_place(wanted.x_m, wanted.y_m)

    def _mistake_in_ball(self, wanted: place_ball_t) -> str:
        for name, value, least, most in (
            ("z_m", wanted.z_m, 0.0, _HIGHEST_M),
            ("vx_m_s", wanted.vx_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
            ("vy_m_s", wanted.vy_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
            ("vz_m_s", wanted.vz_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
        ):
            if not least <= value <= most:
                return f"{name} is {value}; it should be from {least:g} to {most:g}"
        return self._mistake_in_place(wanted.x_m, wanted.y_m)

    def _mistake_in_place(self, x_m: float, y_m: float) -> str:
        if abs(x_m) <= self._x_m and abs(y_m) <= self._y_m:
            return ""
        return f"({x_m:g}, {y_m:g}) is outside the walls; x is at most {self._x_m:g} m, y {self._y_m:g} m"


_NO_ROOM_FOR_BALL = "there is no room left for the ball between the walls"
_HIGHEST_M = 5.0
