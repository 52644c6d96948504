"""Fills the messages of the simulator."""

import math
from collections.abc import Mapping

from lcmtypes.soccer import field_t, game_state_t, match_event_t, true_robot_t
from procs.model.events import Event, Kind
from procs.model.field import Field
from procs.model.robot import CYAN, MAGENTA, Player
from procs.simulation.physics.robot_body import Robot

_TEAMS = {CYAN: game_state_t.TEAM_CYAN, MAGENTA: game_state_t.TEAM_MAGENTA}


def event_message(event: Event, players: Mapping[str, Player]) -> match_event_t:
    """Returns an event for the referee. A goal has no team: the referee knows who attacks that goal in this half."""
    player = None if event.kind is Kind.GOAL else players.get(event.robot)
    message = match_event_t()
    message.kind = int(event.kind)
    message.team = _TEAMS[player.team] if player else game_state_t.TEAM_NONE
    message.robot, message.other = event.robot, event.other
    message.x_m, message.y_m, message.speed_m_s = event.x_m, event.y_m, event.speed_m_s
    return message


def field_message(field: Field) -> field_t:
    """Returns the measures of the field."""
    message = field_t()
    for name, value in field.model_dump().items():
        setattr(message, name, value)
    return message


def robot_message(robot: Robot, player: Player | None, moves: bool = True) -> true_robot_t:
    """Returns a robot's true pose (heading within -pi..pi) and velocity in the world frame; 0 unless it `moves`."""
    message = true_robot_t()
    message.name = robot.name
    if player:
        message.team, message.number = player.team, player.number
    message.x_m, message.y_m = robot.body.position
    message.heading_rad = math.remainder(robot.body.angle, 2 * math.pi)
    if moves:
        message.vx_m_s, message.vy_m_s = robot.body.velocity
        message.omega_rad_s = robot.body.angular_velocity
    return message
