"""Readings of a robot's wheel encoders, compass, gyro and accelerometer, with their errors."""

import math
from typing import NamedTuple

import numpy as np

from procs.model.geometry import clamp
from procs.model.kinematics import Wheels
from procs.simulation.physics.realism import Noise, factor

_ACCELERATION_SD_M_S2 = 0.0  # the simulated accelerometer has no error of its own
_LEAST_S = 1e-3  # a shorter time between readings gives no more noise


class Encoders:
    """Wheel encoders: a constant error of scale for each wheel, and noise that grows with speed."""

    def __init__(self, noise: Noise, rng: np.random.Generator) -> None:
        self._noise = noise
        self._rng = rng
        self._scales = [factor(noise.wheel_scale_sd, drawn) for drawn in rng.standard_normal(3).tolist()]

    def read(self, wheels_m_s: Wheels, passed_s: float) -> list[float]:
        """Returns the rim speeds as measured, `passed_s` after the last reading."""
        deviation = self._noise.wheel_noise_sqrt_s / math.sqrt(max(passed_s, _LEAST_S))
        noise = (deviation * self._rng.standard_normal(3)).tolist()
        return [
            speed * clamp(scale + error, 0.0, 2.0 * scale)  # a wheel that turns ahead counts nothing backwards
            for speed, scale, error in zip(wheels_m_s, self._scales, noise, strict=True)
        ]


class Inertial(NamedTuple):
    """Readings of an inertial measurement unit."""

    heading_rad: float
    """-pi..pi, by the compass."""
    yaw_rate_rad_s: float
    ax_m_s2: float
    """Mean acceleration since the last reading, or since the robot was put down, robot frame."""
    ay_m_s2: float
    heading_sd_rad: float
    """Standard deviation from reading to reading, without the drift; 0: no error."""
    yaw_rate_sd_rad_s: float
    """The same of the yaw rate, without its constant error."""
    acceleration_sd_m_s2: float
    """The same of each acceleration."""


class Imu:
    """Compass, gyro and accelerometer: white noise, a compass whose zero wanders, and a gyro with a constant error."""

    def __init__(self, noise: Noise, rng: np.random.Generator) -> None:
        self._noise = noise
        self._rng = rng
        self._drift_rad = 0.0
        self._bias_rad_s = noise.gyro_bias_sd_rad_s * float(rng.standard_normal())
        self._before_m_s: tuple[float, float] | None = None

    def put_down(self) -> None:
        """Takes note that its robot was put down at rest, which it does not feel."""
        self._before_m_s = (0.0, 0.0)

    def read(
        self, heading_rad: float, yaw_rate_rad_s: float, velocity_m_s: tuple[float, float], passed_s: float
    ) -> Inertial:
        """Returns the readings `passed_s` after the last ones; the velocity is of the world frame."""
        drift, compass, gyro = self._rng.standard_normal(3).tolist()
        self._drift_rad += self._noise.compass_drift_sd_rad * math.sqrt(passed_s / 60.0) * drift
        root = math.sqrt(max(passed_s, _LEAST_S))
        heading_sd_rad, rate_sd_rad_s = self._noise.compass_noise_sqrt_s / root, self._noise.gyro_noise_sqrt_s / root
        measured_rad = heading_rad + self._drift_rad + heading_sd_rad * compass
        rate_rad_s = yaw_rate_rad_s + self._bias_rad_s + rate_sd_rad_s * gyro
        before, self._before_m_s = self._before_m_s or velocity_m_s, velocity_m_s
        ax, ay = ((now - then) / max(passed_s, _LEAST_S) for now, then in zip(velocity_m_s, before, strict=True))
        cosine, sine = math.cos(heading_rad), math.sin(heading_rad)
        return Inertial(
            math.remainder(measured_rad, 2 * math.pi),
            rate_rad_s,
            cosine * ax + sine * ay,
            cosine * ay - sine * ax,
            heading_sd_rad,
            rate_sd_rad_s,
            _ACCELERATION_SD_M_S2,
        )
