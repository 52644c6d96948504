"""Reads what a mate told the team."""

import numpy as np

from lcmtypes.soccer import team_message_t
from procs.model.frames import plausible, wrap
from procs.world_model.seen import Seen
from procs.world_model.team import Mate


def mate_of(message: team_message_t, now_s: float) -> Mate | None:
    """What the message says of its sender; nothing if it comes from the future or says what cannot be."""
    values = (message.x_m, message.y_m, message.heading_rad, message.vx_m_s, message.vy_m_s)
    told_s = message.header.time_us / 1e6
    if told_s > now_s or not plausible(*values):
        return None
    return Mate(
        name=message.robot,
        role=message.role,
        told_s=told_s,
        position_m=np.array((message.x_m, message.y_m)),
        heading_rad=wrap(message.heading_rad),
        velocity_m_s=np.array((message.vx_m_s, message.vy_m_s)),
        localized=message.localized,
    )


def ball_of(message: team_message_t) -> Seen:
    """The ball (0 or 1) that the sender saw, world frame."""
    if not message.ball_visible:
        return Seen.NOTHING
    return Seen.of([(message.ball_x_m, message.ball_y_m)], [message.ball_covariance_m2], [0.0])


def obstacles_of(message: team_message_t) -> Seen:
    """The robots that the sender saw, world frame; its team is not among them."""
    seen = message.obstacles
    if not seen:
        return Seen.NOTHING
    places_m = [(one.x_m, one.y_m) for one in seen]
    return Seen.of(places_m, [one.covariance_m2 for one in seen], [one.radius_m for one in seen])
