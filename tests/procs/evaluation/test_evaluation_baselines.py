"""Baselines that the beliefs are compared with, and the trial in which robots are carried away."""

import math

import numpy as np
import pytest

from fwk.testing import Bench, system_of
from lcmtypes.soccer import team_message_t
from procs.evaluation.average_ball import AverageBall
from procs.evaluation.particle_localization import ParticleLocalization
from procs.evaluation.piece import piece_of
from tests.procs.localization.localization_parts import Course, FakeRobot, until_localized


def test_particles_find_a_robot_and_follow_it() -> None:
    robot = FakeRobot(seed=7)
    robot.place()
    bench = Bench(ParticleLocalization)
    assert until_localized(bench, robot, 8.0) < math.inf
    course, errors_m = Course(robot), []
    for _ in range(100):
        course.step()
        robot.show(bench)
        bench.iterate()
        errors_m.append(float(np.hypot(*robot.error(bench)[:2])))
    assert np.sqrt(np.mean(np.square(errors_m))) < 0.15


def test_particles_find_a_robot_that_was_carried_away() -> None:
    robot = FakeRobot(seed=8)
    robot.place()
    bench = Bench(ParticleLocalization)
    until_localized(bench, robot, 8.0)
    robot.place()
    assert until_localized(bench, robot, 8.0) < math.inf


def test_average_ball_is_the_mean_of_the_teams_newest_sightings() -> None:
    bench = Bench(AverageBall)
    bench.port("pose").put(x_m=1.0, y_m=1.0, heading_rad=math.pi / 2, localized=True)
    bench.port("ball_percept").put(visible=True, x_m=2.0, y_m=0.0)
    told = team_message_t()
    told.robot, told.localized, told.ball_visible = "cyan2", True, True
    told.ball_x_m, told.ball_y_m = 3.0, 1.0
    bench.port("team_inbox").put(messages=[told])
    bench.iterate()
    ball = bench.port("average_ball").sent[-1].ball
    assert (ball.known, ball.observers) == (True, 2)
    assert (ball.x_m, ball.y_m) == pytest.approx((2.0, 2.0))
    bench.iterate(11)
    assert not bench.port("average_ball").sent[-1].ball.known


def test_wanderers_are_put_down_beyond_the_lines_if_asked() -> None:
    settings = {"carried_every_s": 0.2, "carried_inside_m": -0.7, "speed_m_s": 0.0, "turn_rad_s": 0.0}
    wanted = {"world/simulator", "world/referee", "cyan1/base", "cyan1/wanderer"}
    system = system_of("kidnapped.yaml", wanted.__contains__, 2, wanderer=settings)
    places_m = set()
    for _ in range(300):
        system.tick()
        robot = system.newest("world/ground_truth").robots[0]
        places_m.add((round(robot.x_m, 1), round(robot.y_m, 1)))
    beyond_m = [max(abs(x_m) - 11.0, abs(y_m) - 7.0) for x_m, y_m in places_m]
    assert 0.0 < max(beyond_m) < 0.75
    assert min(beyond_m) < -3.0


def test_wanderers_drive_and_are_carried_away() -> None:
    here = ("world/", "cyan1/")
    system = system_of("kidnapped.yaml", lambda name: name.startswith(here), 2, wanderer={"carried_every_s": 1.5})
    system.tick(45)
    piece = piece_of(system.sent, 0.05)
    places_m = np.array([(each.x_m, each.y_m) for each in (piece.robot(tick, "cyan1") for tick in sorted(piece.truth))])
    steps_m = np.hypot(*np.diff(places_m, axis=0).T)
    assert (steps_m > 1.0).sum() == 1
    assert steps_m[:25].sum() > 0.3
    assert set(piece.by_robot) >= {"pose", "particle_pose"}
