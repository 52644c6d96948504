"""Robots drawn from the truth lie between rays of the detector, as robots in pictures do."""

import math
from typing import Any

import numpy as np

from fwk.testing import Bench
from lcmtypes.soccer import ground_truth_t, obstacle_percepts_t, true_robot_t
from procs.model.algebra import Floats
from procs.simulation.percepts import Percepts

AWAY_M = 4.5


def aside(**settings: Any) -> tuple[Floats, Floats]:
    """Returns the errors across the ray of a robot seen in 200 directions, in m and in stated deviations."""
    eyes = Bench(Percepts, name="cyan1/percepts", realism="none", **settings)
    errors_m, stated_m = [], []
    for number in range(200):
        angle_rad = 2.4 * number
        left = np.array((-math.sin(angle_rad), math.cos(angle_rad)))
        other = true_robot_t(name="magenta1", x_m=AWAY_M * math.cos(angle_rad), y_m=AWAY_M * math.sin(angle_rad))
        eyes.port("ground_truth").put(ground_truth_t(robots=[true_robot_t(name="cyan1"), other]))
        eyes.iterate()
        percepts: obstacle_percepts_t = eyes.port("obstacle_percepts").sent[-1]
        (seen,) = percepts.obstacles
        errors_m.append(left @ (seen.x_m, seen.y_m))
        stated_m.append(math.sqrt(left @ np.array(seen.covariance_m2) @ left))
    return np.array(errors_m), np.array(errors_m) / stated_m


def rms(errors: Floats) -> float:
    return math.sqrt(np.square(errors).mean())


def test_narrow_robots_meet_as_many_rays_as_in_pictures() -> None:
    errors_m, _ = aside(robot={"radius_m": 0.15})
    assert rms(errors_m) < 0.012


def test_percepts_state_what_the_distance_between_rays_hides() -> None:
    errors_m, surprises = aside()
    assert rms(errors_m) > 0.03
    assert 0.7 < rms(surprises) < 1.2
