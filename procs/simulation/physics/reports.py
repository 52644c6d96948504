"""Fills the messages of the simulator."""

import math

from lcmtypes.soccer import game_state_t, match_event_t, true_robot_t
from procs.model.robot import CYAN, MAGENTA, team_of
from procs.simulation.physics.events import Event, Kind
from procs.simulation.physics.robot_body import Robot

_TEAMS = {CYAN: game_state_t.TEAM_CYAN, MAGENTA: game_state_t.TEAM_MAGENTA}


def event_message(event: Event) -> match_event_t:
    """Returns an event for the referee; the team of a goal is the one that attacks that goal."""
    message = match_event_t()
    message.kind = int(event.kind)
    scorer = CYAN if event.x_m > 0 else MAGENTA
    message.team = _TEAMS.get(scorer if event.kind is Kind.GOAL else team_of(event.robot), game_state_t.TEAM_NONE)
    message.robot, message.other = event.robot, event.other
    message.x_m, message.y_m, message.speed_m_s = event.x_m, event.y_m, event.speed_m_s
    return message


def robot_message(robot: Robot) -> true_robot_t:
    """Returns a robot's true pose (heading within -pi..pi) and velocity in the world frame."""
    message = true_robot_t()
    message.name = robot.name
    message.x_m, message.y_m = robot.body.position
    message.heading_rad = math.remainder(robot.body.angle, 2 * math.pi)
    message.vx_m_s, message.vy_m_s = robot.body.velocity
    message.omega_rad_s = robot.body.angular_velocity
    return message
