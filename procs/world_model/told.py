"""Reads the messages of team mates."""

import math

import numpy as np

from lcmtypes.soccer import team_message_t
from procs.model.covariance import is_covariance
from procs.model.frames import Floats
from procs.model.geometry import plausible, wrap_rad
from procs.model.robot import FASTEST_M_S
from procs.model.units import US_PER_S
from procs.world_model.seen import MOST_OBSTACLES, Seen
from procs.world_model.team import Mate

IN_MOUTH_M = 0.03
"""Deviation of a ball's place in a mouth."""
_MATE_M_S = 0.3  # deviation of the velocity of a mate's mouth, whose turning follows from its last two messages


def mate_of(message: team_message_t, now_s: float) -> Mate | None:
    """Returns the state of the sender; None if the message has no name, is from the future or has impossible values."""
    values = (message.x_m, message.y_m, message.heading_rad, message.vx_m_s, message.vy_m_s)
    told_s = message.header.time_us / US_PER_S
    sound = plausible(*values) and math.hypot(message.vx_m_s, message.vy_m_s) < FASTEST_M_S
    if not (message.robot and told_s <= now_s and sound and is_covariance(message.pose_covariance)):
        return None
    return Mate(
        name=message.robot,
        role=message.role,
        told_s=told_s,
        position_m=np.array((message.x_m, message.y_m)),
        heading_rad=wrap_rad(message.heading_rad),
        velocity_m_s=np.array((message.vx_m_s, message.vy_m_s)),
        localized=message.localized,
        covariance_m2=np.array(message.pose_covariance)[:2, :2],
        number=message.number,
        holds_ball=bool(message.ball_held),
        agreement=message.agreement,
    )


def ball_of(message: team_message_t) -> Seen:
    """Returns the ball (0 or 1) that the sender saw, world frame."""
    if not message.ball_visible:
        return Seen.NOTHING
    return Seen.of([(message.ball_x_m, message.ball_y_m)], [message.ball_covariance_m2], [0.0])


def mouth_of(mate: Mate, mouth_m: float, time_s: float) -> Seen:
    """Returns the place of a ball (0 or 1) in a mate's mouth at a time near its message; 0 if the mate is lost."""
    if not mate.localized:
        return Seen.NOTHING
    ahead_m = mouth_m * np.array((np.cos(mate.heading_rad), np.sin(mate.heading_rad)))
    return Seen.of([mate.position_at(time_s) + ahead_m], [mate.covariance_m2 + np.eye(2) * IN_MOUTH_M**2], [0.0])


def held_by(mate: Mate, mouth_m: float) -> tuple[Floats, Floats]:
    """Returns the state (4) of the ball in a mate's mouth at `told_s`, and its covariance (4, 4).

    The ball moves and turns with the mate; `mouth_m` is from its middle to the ball's.
    """
    offset_m = mouth_m * np.array((np.cos(mate.heading_rad), np.sin(mate.heading_rad)))
    turning_m_s = mate.omega_rad_s * np.array((-offset_m[1], offset_m[0]))
    covariance = np.zeros((4, 4))
    covariance[:2, :2] = mate.covariance_m2
    covariance[2:, 2:] = np.eye(2) * _MATE_M_S**2
    return np.concatenate((mate.position_m + offset_m, mate.velocity_m_s + turning_m_s)), covariance


def obstacles_of(message: team_message_t) -> Seen:
    """Returns the robots that the sender saw, world frame, without those of its team."""
    seen = message.obstacles[:MOST_OBSTACLES]
    if not seen:
        return Seen.NOTHING
    places_m = [(one.x_m, one.y_m) for one in seen]
    return Seen.of(places_m, [one.covariance_m2 for one in seen], [one.radius_m for one in seen])
