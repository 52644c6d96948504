"""Readings of a robot's wheel encoders and compass, with their errors."""

import math

import numpy as np

from procs.model.kinematics import Wheels
from procs.simulation.physics.realism import Noise


class Encoders:
    """Wheel encoders: a constant error of scale for each wheel, and noise that grows with speed."""

    def __init__(self, noise: Noise, rng: np.random.Generator) -> None:
        self._noise = noise
        self._rng = rng
        self._scales = (1.0 + noise.wheel_scale_sd * rng.standard_normal(3)).tolist()

    def read(self, wheels_m_s: Wheels) -> list[float]:
        """Returns the rim speeds as measured."""
        noise = (self._noise.wheel_speed_sd * self._rng.standard_normal(3)).tolist()
        return [speed * (scale + error) for speed, scale, error in zip(wheels_m_s, self._scales, noise, strict=True)]


class Imu:
    """Compass and gyro: white noise, and a compass whose zero wanders."""

    def __init__(self, noise: Noise, rng: np.random.Generator) -> None:
        self._noise = noise
        self._rng = rng
        self._drift_rad = 0.0

    def read(self, heading_rad: float, yaw_rate_rad_s: float, passed_s: float) -> tuple[float, float]:
        """Returns heading (-pi..pi) and yaw rate as measured, `passed_s` after the last reading."""
        drift, compass, gyro = self._rng.standard_normal(3).tolist()
        self._drift_rad += self._noise.compass_drift_sd_rad * math.sqrt(passed_s / 60.0) * drift
        measured_rad = heading_rad + self._drift_rad + self._noise.compass_sd_rad * compass
        return math.remainder(measured_rad, 2 * math.pi), yaw_rate_rad_s + self._noise.gyro_sd_rad_s * gyro
