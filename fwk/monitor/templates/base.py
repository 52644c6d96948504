"""Prints speed and position of a base four times a second."""

from typing import Any

channels = ("*/odometry",)
due_us: dict[str, int] = {}


def message(channel: str, message: Any, time_us: int) -> None:
    if time_us >= due_us.get(channel, 0):
        due_us[channel] = time_us + 250_000
        speed_m_s = (message.vx_m_s**2 + message.vy_m_s**2) ** 0.5
        print(f"{time_us / 1e6:8.2f} s  {channel}: {speed_m_s:.2f} m/s at ({message.x_m:.2f}, {message.y_m:.2f}) m")
