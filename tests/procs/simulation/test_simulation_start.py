"""Names, formation and free positions, delays and sensors."""

import math
from typing import Literal

import numpy as np
import pytest

from procs.model.field import Field, Point
from procs.model.robot import PLAYERS, Player, number_of, side_of, team_of
from procs.simulation.physics.delay import DelayLine
from procs.simulation.physics.realism import PRESETS, Noise
from procs.simulation.physics.sensors import Encoders, Imu
from procs.simulation.physics.start_places import free_place, starting_pose

FIELD = Field()


def test_names_give_team_number_and_side() -> None:
    assert (team_of("cyan3"), number_of("cyan3"), side_of("cyan")) == ("cyan", 3, -1.0)
    assert (team_of("magenta12"), number_of("magenta12"), side_of("magenta")) == ("magenta", 12, 1.0)
    assert (team_of("robby"), number_of("robby"), side_of("robby")) == ("robby", 0, -1.0)


@pytest.mark.parametrize("team", ["cyan", "magenta"])
def test_robots_start_apart_in_their_half_outside_the_circle(team: Literal["cyan", "magenta"]) -> None:
    poses = [starting_pose(Player(team=team, number=number), FIELD) for number in range(1, 10)]
    side = side_of(team)
    assert all(side * pose.x_m > 0.6 and FIELD.in_field(pose.x_m, pose.y_m) for pose in poses)
    assert all(math.hypot(pose.x_m, pose.y_m) > 2.3 for pose in poses)
    assert all(math.cos(pose.heading_rad) == -side for pose in poses)
    gaps = [math.dist(one[:2], two[:2]) for index, one in enumerate(poses) for two in poses[:index]]
    assert min(gaps) > 0.8


def test_number_one_keeps_the_goal() -> None:
    pose = starting_pose(PLAYERS["magenta1"], FIELD)
    assert FIELD.in_goal_area(pose.x_m, pose.y_m, 1.0)


def test_free_position_is_used_unchanged() -> None:
    assert free_place(Point(1.0, 2.0), [Point(1.0, 2.5)], 0.4) == (1.0, 2.0)


def test_position_between_two_robots_moves_out_of_both() -> None:
    robots = [Point(0.0, 0.0), Point(0.5, 0.0)]
    place = free_place(Point(0.2, 0.05), robots, 0.4)
    assert min(math.dist(place, robot) for robot in robots) >= 0.4 - 1e-9
    assert math.dist(place, (0.2, 0.05)) < 0.5


def test_position_at_the_very_centre_of_a_robot_has_a_way_out() -> None:
    assert free_place(Point(1.0, 1.0), [Point(1.0, 1.0)], 0.4) == pytest.approx((1.0, 1.4))


def test_delay_line_keeps_order_and_time() -> None:
    line: DelayLine[str] = DelayLine(100)
    line.put("a", 0)
    line.put("b", 30)
    assert line.due(99) == []
    assert line.due(100) == ["a"]
    assert line.due(500) == ["b"]


def test_ideal_sensors_report_the_truth() -> None:
    rng = np.random.default_rng(1)
    assert Encoders(Noise(), rng).read((1.0, -2.0, 0.5), 0.05) == [1.0, -2.0, 0.5]
    imu = Imu(Noise(), rng)
    heading_rad, yaw_rate_rad_s, *_ = imu.read(3.5, 0.7, (1.0, 0.0), 0.05)
    assert heading_rad == pytest.approx(3.5 - 2 * math.pi)
    assert yaw_rate_rad_s == 0.7
    reading = imu.read(math.pi / 2, 0.7, (1.0, 0.2), 0.05)
    assert (reading.ax_m_s2, reading.ay_m_s2) == pytest.approx((4.0, 0.0))
    assert (reading.heading_sd_rad, reading.yaw_rate_sd_rad_s, reading.acceleration_sd_m_s2) == (0.0, 0.0, 0.0)


def test_sensor_noise_is_the_same_in_a_second_at_any_rate() -> None:
    """A second of readings tells as much at 20 Hz as at 500 Hz."""
    ways = {}
    for rate_hz in (20, 500):
        encoders = Encoders(Noise(wheel_noise_sqrt_s=0.01), np.random.default_rng(1))
        imu = Imu(Noise(gyro_noise_sqrt_s=0.01), np.random.default_rng(2))
        readings = np.array([encoders.read((1.0, 1.0, 1.0), 1 / rate_hz) for _ in range(100 * rate_hz)])
        rates = np.array([imu.read(0.0, 0.0, (0.0, 0.0), 1 / rate_hz)[1] for _ in range(100 * rate_hz)])
        seconds = readings.mean(axis=1).reshape(100, rate_hz).mean(axis=1)
        ways[rate_hz] = seconds.std() * math.sqrt(3), rates.reshape(100, rate_hz).mean(axis=1).std()
    assert ways[20] == pytest.approx((0.01, 0.01), rel=0.25)
    assert ways[500] == pytest.approx((0.01, 0.01), rel=0.25)


def test_wheel_errors_are_a_constant_scale_and_some_noise() -> None:
    scales = []
    for seed in range(200):
        encoders = Encoders(PRESETS["realistic"], np.random.default_rng(seed))
        readings = np.array([encoders.read((2.0, 2.0, 2.0), 0.05) for _ in range(100)])
        assert 0.08 < readings.std(axis=0).mean() < 0.12
        scales.append(readings.mean() / 2.0)
    assert np.std(scales) == pytest.approx(0.03 / math.sqrt(3), rel=0.15)


def test_wheels_at_rest_are_measured_at_rest() -> None:
    assert Encoders(PRESETS["harsh"], np.random.default_rng(1)).read((0.0, 0.0, 0.0), 0.05) == [0.0, 0.0, 0.0]


def test_compass_drifts_like_a_random_walk() -> None:
    drifts = []
    for seed in range(100):
        imu = Imu(Noise(compass_drift_sd_rad=0.05), np.random.default_rng(seed))
        for _ in range(60):
            heading_rad, *_ = imu.read(0.0, 0.0, (0.0, 0.0), 1.0)
        drifts.append(heading_rad)
    assert np.std(drifts) == pytest.approx(0.05, rel=0.2)


def test_presets_grow_harsher() -> None:
    for name in Noise.model_fields:
        values = [getattr(noise, name) for noise in PRESETS.values()]
        assert values[0] == 0.0
        assert values == sorted(set(values))
