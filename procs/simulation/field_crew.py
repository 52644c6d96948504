"""Carries out what people and programs ask of the world: robots and ball are put down, the world stands still."""

import math
from collections.abc import Iterable

from fwk import Serves
from lcmtypes.soccer import freeze_world_t, hold_robot_t, place_ball_t, place_robot_t, reset_world_t
from procs.model.field import Field
from procs.simulation.physics.ball_body import THROW_LIMIT_M_S
from procs.simulation.physics.start_places import Pose
from procs.simulation.physics.world import World


class FieldCrew:
    """Answers the commands of a tick, in the order: reset, robots, robots to hold, ball, freeze."""

    def __init__(self, world: World, field: Field) -> None:
        self.frozen = False
        """True while robots and ball stand still."""
        self.held: set[str] = set()
        """Robots whose motors and kicker stand."""
        self.put_down: set[str] = set()
        """Robots that were put down in this tick."""
        self._world = world
        self._field = field

    def carry_out(
        self,
        place_robot: Serves[place_robot_t],
        hold_robot: Serves[hold_robot_t],
        place_ball: Serves[place_ball_t],
        freeze: Serves[freeze_world_t],
        reset: Serves[reset_world_t],
    ) -> None:
        """Takes all waiting commands."""
        self.put_down.clear()
        for beginning in reset:
            self._world.return_to_starts()
            self.held.clear()
            self.put_down.update(self._world.robots)
            if beginning.value.keep_ball or self._world.place_ball(0.0, 0.0):
                beginning.done()
            else:
                beginning.fail(_NO_ROOM_FOR_BALL)
        for robot in place_robot:
            mistake = robot_mistake(robot.value, self._world.robots, self._field)
            if mistake:
                robot.reject(mistake)
                continue
            wanted = robot.value
            if self._world.place_robot(wanted.robot, Pose(wanted.x_m, wanted.y_m, wanted.heading_rad)):
                self.put_down.add(wanted.robot)
                robot.done()
            else:
                robot.reject(f"there is no room left for {wanted.robot} between the walls")
        for hold in hold_robot:
            stranger = _stranger(hold.value.robot, self._world.robots)
            if stranger:
                hold.reject(stranger)
                continue
            (self.held.add if hold.value.held else self.held.discard)(hold.value.robot)
            if hold.value.held:
                self._world.kickers[hold.value.robot].drop_commands()
            hold.done()
        for ball in place_ball:
            mistake = ball_mistake(ball.value, self._field)
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


def robot_mistake(wanted: place_robot_t, robots: Iterable[str], field: Field) -> str:
    """Returns why a robot cannot be set down there, or an empty text."""
    stranger = _stranger(wanted.robot, robots)
    if stranger:
        return stranger
    if not math.isfinite(wanted.heading_rad):
        return f"heading_rad is {wanted.heading_rad}; it should be a number"
    return _place_mistake(wanted.x_m, wanted.y_m, field)


def ball_mistake(wanted: place_ball_t, field: Field) -> str:
    """Returns why the ball cannot be put down or thrown there, or an empty text."""
    for name, value, least, most in (
        ("z_m", wanted.z_m, 0.0, _HIGHEST_M),
        ("vx_m_s", wanted.vx_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
        ("vy_m_s", wanted.vy_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
        ("vz_m_s", wanted.vz_m_s, -THROW_LIMIT_M_S, THROW_LIMIT_M_S),
    ):
        if not least <= value <= most:
            return f"{name} is {value}; it should be from {least:g} to {most:g}"
    return _place_mistake(wanted.x_m, wanted.y_m, field)


def _stranger(robot: str, robots: Iterable[str]) -> str:
    known = list(robots)
    return "" if robot in known else f"no robot '{robot}'; there are: {', '.join(known)}"


def _place_mistake(x_m: float, y_m: float, field: Field) -> str:
    most_x_m, most_y_m = field.half_length_m + field.border_m, field.half_width_m + field.border_m
    if abs(x_m) <= most_x_m and abs(y_m) <= most_y_m:
        return ""
    return f"({x_m:g}, {y_m:g}) is outside the walls; x is at most {most_x_m:g} m, y {most_y_m:g} m"


_NO_ROOM_FOR_BALL = "there is no room left for the ball between the walls"
_HIGHEST_M = 5.0
