"""Game pieces with known truth, for the tests of the measures."""

from typing import Any

import numpy as np

from lcmtypes.soccer import ball_estimate_t, game_state_t, ground_truth_t, match_event_t, true_robot_t, world_model_t
from procs.evaluation.piece import Piece

FIRST = 100  # tick; measuring begins some seconds after the start


def robot(name: str, x_m: float, y_m: float, vx_m_s: float = 0.0) -> true_robot_t:
    """Makes a robot with its true place."""
    made = true_robot_t()
    made.name, made.x_m, made.y_m, made.vx_m_s = name, x_m, y_m, vx_m_s
    return made


def event(kind: int, name: str, speed_m_s: float = 0.0) -> match_event_t:
    """Makes an event of a robot."""
    made = match_event_t()
    made.kind, made.robot, made.speed_m_s = kind, name, speed_m_s
    return made


def model(ball_m: tuple[float, float], deviation_m: float = 0.1, **values: Any) -> world_model_t:
    """Makes the beliefs of a robot that knows the ball."""
    made = world_model_t()
    made.ball = ball_estimate_t()
    made.ball.known = True
    made.ball.x_m, made.ball.y_m = ball_m
    made.ball.covariance = np.diag([deviation_m**2] * 4).tolist()
    made.localized = True
    for name, value in values.items():
        setattr(made, name, value)
    return made


def piece(robots: list[true_robot_t], ticks: int = 40, vx_m_s: float = 1.0) -> Piece:
    """Makes a piece in which the ball rolls along x, from the centre, and all robots stand still."""
    made = Piece(0.05)
    for tick in range(FIRST, FIRST + ticks):
        truth = made.truth[tick] = ground_truth_t()
        truth.robots = robots
        truth.ball_x_m, truth.ball_vx_m_s = (tick - FIRST) * 0.05 * vx_m_s, vx_m_s
    return made


def playing() -> game_state_t:
    """Returns the state of a running game."""
    game = game_state_t()
    game.state = game_state_t.PLAY
    return game
