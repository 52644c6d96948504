"""A world model that knows the truth, with noise if configured, for matches without vision."""

import numpy as np
from pydantic import NonNegativeFloat

from fwk import Clock, Component, Config, Each, Reads, Writes, channel
from lcmtypes.soccer import (
    ball_estimate_t,
    ground_truth_t,
    line_points_t,
    mate_estimate_t,
    obstacle_percepts_t,
    robot_estimate_t,
    role_t,
    true_robot_t,
    world_model_t,
)
from procs.model.robot import ABSENT, team_in
from procs.world_model.settings import RESTART_S

_ROUNDING_M2 = 1e-8
"""A covariance without noise is that of rounding."""


class PerfectWorldModelConfig(Config):
    """Standard deviations of the errors."""

    place_sd_m: NonNegativeFloat = 0.0
    heading_sd_rad: NonNegativeFloat = 0.0
    ball_sd_m: NonNegativeFloat = 0.0
    ball_velocity_sd_m_s: NonNegativeFloat = 0.0


class PerfectWorldModel(Component):
    """Replaces camera, vision, localization, world model and radio of one robot."""

    stage = "worldstate"

    config: PerfectWorldModelConfig
    clock: Clock
    rng: np.random.Generator
    ground_truth: Reads[ground_truth_t] = channel("world/ground_truth")
    role: Each[Reads[role_t]] = channel("*/role")
    world_model: Writes[world_model_t]
    obstacle_percepts: Writes[obstacle_percepts_t]
    """Never written, like `line_points`: only robots that do not know their places need them."""
    line_points: Writes[line_points_t]

    def loop(self) -> None:
        robot, truth, config = self.name.rpartition("/")[0], self.ground_truth.value, self.config
        own = next((each for each in truth.robots if each.name == robot), None)
        if own is None:
            return
        model = world_model_t()
        noise = self.rng.standard_normal(7).tolist()
        model.localized = True
        model.x_m, model.y_m = own.x_m + config.place_sd_m * noise[0], own.y_m + config.place_sd_m * noise[1]
        model.heading_rad = own.heading_rad + config.heading_sd_rad * noise[2]
        model.vx_m_s, model.vy_m_s = own.vx_m_s, own.vy_m_s
        ball = ball_estimate_t()
        ball.known, ball.observers = True, 1
        ball.x_m, ball.y_m = truth.ball_x_m + config.ball_sd_m * noise[3], truth.ball_y_m + config.ball_sd_m * noise[4]
        ball.z_m, ball.vz_m_s = truth.ball_z_m, truth.ball_vz_m_s
        ball.vx_m_s = truth.ball_vx_m_s + config.ball_velocity_sd_m_s * noise[5]
        ball.vy_m_s = truth.ball_vy_m_s + config.ball_velocity_sd_m_s * noise[6]
        place_m2, velocity_m2_s2 = config.ball_sd_m**2 + _ROUNDING_M2, config.ball_velocity_sd_m_s**2 + _ROUNDING_M2
        ball.covariance = np.diag([place_m2, place_m2, velocity_m2_s2, velocity_m2_s2]).tolist()
        model.ball = ball
        others = [each for each in truth.robots if each.name != robot]
        said = {name: role.value for name, role in self.role.items() if self._plays(role)}
        silent = role_t(role=ABSENT)
        model.mates = [_mate(each, said.get(each.name, silent)) for each in others if team_in(each) == team_in(own)]
        model.opponents = [_opponent(each) for each in others if team_in(each) != team_in(own)]
        self.world_model.value = model
        self.world_model.write()

    def _plays(self, role: Reads[role_t]) -> bool:
        return self.clock.since_s(role.header.time_us) <= RESTART_S


def _mate(robot: true_robot_t, said: role_t) -> mate_estimate_t:
    estimate = mate_estimate_t(name=robot.name, role=said.role, agreement=said.agreement)
    estimate.x_m, estimate.y_m, estimate.heading_rad = robot.x_m, robot.y_m, robot.heading_rad
    estimate.vx_m_s, estimate.vy_m_s = robot.vx_m_s, robot.vy_m_s
    return estimate


def _opponent(robot: true_robot_t) -> robot_estimate_t:
    return robot_estimate_t(x_m=robot.x_m, y_m=robot.y_m, vx_m_s=robot.vx_m_s, vy_m_s=robot.vy_m_s)
