"""Fills the messages of the world model."""

from collections.abc import Sequence

import numpy as np

from lcmtypes.robot import battery_state_t
from lcmtypes.soccer import (
    ball_estimate_t,
    drive_target_t,
    mate_estimate_t,
    obstacle_t,
    robot_estimate_t,
    team_message_t,
    world_model_t,
)
from procs.model.geometry import plausible
from procs.model.units import US_PER_S
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.kicks import Kick
from procs.world_model.own_view import OwnView
from procs.world_model.robot_tracks import RobotTracks
from procs.world_model.seen import Seen
from procs.world_model.team import Mate, PlaceRow


def fill_world_model(
    message: world_model_t,
    view: OwnView,
    ball: BallTracker,
    mates: Sequence[Mate],
    team: Sequence[PlaceRow],
    opponents: RobotTracks,
    silent: RobotTracks,
    quiet: frozenset[int],
    now_s: float,
) -> None:
    """Fills in the beliefs of the robot at `now_s`.

    `team` begins with the places of the `mates`; silent robots with the numbers `quiet` are among these.
    """
    message.localized = view.localized
    message.x_m, message.y_m, message.heading_rad = view.pose.tolist()
    message.vx_m_s, message.vy_m_s = view.velocity_m_s.tolist()
    message.ball = _ball(ball)
    rows = zip(mates, team[: len(mates)], strict=True)
    message.mates = [_mate(mate, place, now_s) for mate, place in rows]
    message.opponents = _robots(opponents)
    message.silent_mates = [robot for robot in _robots(silent) if robot.id not in quiet] if len(silent) else []


def fill_team_message(message: team_message_t, view: OwnView, ball: Seen, obstacles: Seen) -> None:
    """Fills in the own pose and the own sightings: ball (0 or 1), and obstacles without robots of the team."""
    message.pose_covariance = view.covariance.tolist()
    message.x_m, message.y_m, message.heading_rad = view.pose.tolist()
    message.vx_m_s, message.vy_m_s = view.velocity_m_s.tolist()
    message.localized = view.localized
    message.ball_visible = len(ball.positions_m) > 0
    if message.ball_visible:
        message.ball_x_m, message.ball_y_m = ball.positions_m[0].tolist()
        message.ball_covariance_m2 = ball.covariances_m2[0].tolist()
        message.ball_distance_m = float(np.hypot(*(ball.positions_m[0] - view.pose[:2])))
    message.obstacles = []
    rows = zip(obstacles.positions_m, obstacles.covariances_m2, obstacles.radii_m, strict=True)
    for position_m, covariance_m2, radius_m in rows:
        obstacle = obstacle_t()
        obstacle.x_m, obstacle.y_m = position_m.tolist()
        obstacle.covariance_m2 = covariance_m2.tolist()
        obstacle.radius_m = float(radius_m)
        message.obstacles.append(obstacle)


def fill_plan(message: team_message_t, target: drive_target_t | None, battery: battery_state_t | None) -> None:
    """Fills in where the robot is driving to, and the charge of its battery.

    Args:
        message: to the team.
        target: newest target of the skiller; None if there is none or it is out of date.
        battery: newest state of the battery; None if it is not known.
    """
    place = (0.0, 0.0, 0.0)
    message.has_target = False
    if target is not None and not target.stop and plausible(target.x_m, target.y_m, target.heading_rad):
        message.has_target, place = True, (target.x_m, target.y_m, target.heading_rad)
    message.target_x_m, message.target_y_m, message.target_heading_rad = place
    message.battery_known = battery is not None and _is_share(battery.charge)
    message.battery_charge = battery.charge if battery is not None and message.battery_known else 0.0


def fill_ball(message: team_message_t, belief: ball_estimate_t, confidence: float) -> None:
    """Fills in what the robot believes about the ball's velocity, and the confidence of its own sighting."""
    message.ball_known = belief.known
    message.ball_vx_m_s, message.ball_vy_m_s = (belief.vx_m_s, belief.vy_m_s) if belief.known else (0.0, 0.0)
    message.ball_confidence = confidence if message.ball_visible and _is_share(confidence) else 0.0


def fill_kick(message: team_message_t, kick: Kick, kicks: int, now_us: int) -> None:
    """Fills in the newest own kick; `kicks` is its number."""
    message.kicks, message.kick_us = kicks, now_us - round(kick.age_s * US_PER_S)
    message.kick_vx_m_s, message.kick_vy_m_s = kick.velocity_m_s.tolist()
    message.kick_vz_m_s = kick.lift_m_s


def _is_share(value: float) -> bool:
    """Returns whether a value is from 0 to 1; NaN is not."""
    return 0.0 <= value <= 1.0


def _ball(ball: BallTracker) -> ball_estimate_t:
    estimate = ball_estimate_t()
    estimate.known = ball.known
    if estimate.known:
        track = ball.track
        estimate.x_m, estimate.y_m, estimate.vx_m_s, estimate.vy_m_s = track.state.tolist()
        estimate.covariance = track.covariance.tolist()
        flight = ball.flight
        if flight is not None:
            estimate.z_m, estimate.vz_m_s = flight.height_m, flight.lift_m_s
        estimate.age_s = ball.age_s
        estimate.observers = ball.observers
    return estimate


def _mate(mate: Mate, place: PlaceRow, now_s: float) -> mate_estimate_t:
    estimate = mate_estimate_t()
    estimate.name, estimate.number = mate.name, mate.number
    estimate.role, estimate.agreement = mate.role, mate.agreement
    estimate.x_m, estimate.y_m, estimate.vx_m_s, estimate.vy_m_s, xx_m2, xy_m2, yx_m2, yy_m2 = place
    estimate.heading_rad = mate.heading_rad
    estimate.covariance_m2 = [[xx_m2, xy_m2], [yx_m2, yy_m2]]
    estimate.age_s = now_s - mate.told_s
    return estimate


def _robots(tracks: RobotTracks) -> list[robot_estimate_t]:
    """Returns the tracks that have more than one sighting."""
    states, covariances_m2 = tracks.states.tolist(), tracks.covariances[:, :2, :2].tolist()
    ages_s, ids, estimates = tracks.ages_s.tolist(), tracks.ids.tolist(), []
    for track in tracks.sure.tolist():
        estimate = robot_estimate_t()
        estimate.id = ids[track]
        estimate.x_m, estimate.y_m, estimate.vx_m_s, estimate.vy_m_s = states[track]
        estimate.covariance_m2, estimate.age_s = covariances_m2[track], ages_s[track]
        estimates.append(estimate)
    return estimates
