"""Prints each fix of a GPS receiver with its number of satellites."""

from typing import Any

channels = ("*/gps",)
KINDS = ("none", "fix", "differential", "kinematic")


def message(channel: str, message: Any, time_us: int) -> None:
    place = f"{message.latitude_deg:.7f}, {message.longitude_deg:.7f}, {message.altitude_m:.1f} m"
    print(f"{time_us / 1e6:8.2f} s  {channel}: {place}; {KINDS[message.kind]}, {message.satellites} satellites")
