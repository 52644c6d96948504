"""Prints heading and turning rate of an IMU, and the largest acceleration at the end."""

from math import degrees, hypot
from typing import Any

channels = ("*/imu",)
largest_m_s2 = 0.0


def message(channel: str, message: Any, time_us: int) -> None:
    global largest_m_s2
    largest_m_s2 = max(largest_m_s2, hypot(message.ax_m_s2, message.ay_m_s2))
    turning = degrees(message.yaw_rate_rad_s)
    print(f"{time_us / 1e6:8.2f} s  {channel}: {degrees(message.heading_rad):6.1f} deg, {turning:6.1f} deg/s")


def end() -> None:
    print(f"largest acceleration: {largest_m_s2:.2f} m/s^2")
