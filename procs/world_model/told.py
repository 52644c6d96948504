"""Reads the messages of team mates."""

import numpy as np

from lcmtypes.soccer import team_message_t
from procs.model.frames import wrap
from procs.model.geometry import plausible
from procs.world_model.seen import Seen
from procs.world_model.team import Mate


def mate_of(message: team_message_t, now_s: float) -> Mate | None:
    """Returns the state of the sender; None if the message is from the future or holds impossible values."""
    values = (message.x_m, message.y_m, message.heading_rad, message.vx_m_s, message.vy_m_s)
    told_s = message.header.time_us / 1e6
    if told_s > now_s or not plausible(*values):
        return None
    (xx_m2, xy_m2, _), (yx_m2, yy_m2, _), _ = message.pose_covariance
    proper = plausible(xx_m2, xy_m2, yx_m2, yy_m2) and min(xx_m2, yy_m2, xx_m2 * yy_m2 - xy_m2 * yx_m2) >= 0.0
    return Mate(
        name=message.robot,
        role=message.role,
        told_s=told_s,
        position_m=np.array((message.x_m, message.y_m)),
        heading_rad=wrap(message.heading_rad),
        velocity_m_s=np.array((message.vx_m_s, message.vy_m_s)),
        localized=message.localized,
        covariance_m2=np.array(((xx_m2, xy_m2), (yx_m2, yy_m2))) if proper else np.zeros((2, 2)),
        number=message.number,
        holds_ball=bool(message.ball_held),
        agreement=message.agreement,
    )


def ball_of(message: team_message_t) -> Seen:
    """Returns the ball (0 or 1) that the sender saw, world frame."""
    if not message.ball_visible:
        return Seen.NOTHING
    return Seen.of([(message.ball_x_m, message.ball_y_m)], [message.ball_covariance_m2], [0.0])


def held_ball_of(message: team_message_t, mate: Mate, mouth_m: float) -> Seen:
    """Returns the ball (0 or 1) in the sender's mouth, world frame; `mouth_m` is from its middle to the ball's."""
    return mouth_of(mate, mouth_m, mate.told_s) if message.ball_held else Seen.NOTHING


def mouth_of(mate: Mate, mouth_m: float, time_s: float) -> Seen:
    """Returns the place of a ball in a mate's mouth at a time near its message; none if the mate is lost."""
    if not mate.localized:
        return Seen.NOTHING
    ahead_m = mouth_m * np.array((np.cos(mate.heading_rad), np.sin(mate.heading_rad)))
    return Seen.of([mate.position_at(time_s) + ahead_m], [mate.covariance_m2 + np.eye(2) * 0.03**2], [0.0])


def obstacles_of(message: team_message_t) -> Seen:
    """Returns the robots that the sender saw, world frame, without those of its team."""
    seen = message.obstacles
    if not seen:
        return Seen.NOTHING
    places_m = [(one.x_m, one.y_m) for one in seen]
    return Seen.of(places_m, [one.covariance_m2 for one in seen], [one.radius_m for one in seen])
