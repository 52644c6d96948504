"""Prints the nearest obstacle in each scan of a laser range finder."""

from math import degrees
from typing import Any

channels = ("*/laser", "*/scan")


def message(channel: str, message: Any, time_us: int) -> None:
    valid = [
        (range_m, number)
        for number, range_m in enumerate(message.ranges_m)
        if message.range_min_m <= range_m <= message.range_max_m
    ]
    if valid:
        range_m, number = min(valid)
        angle_rad = message.angle_min_rad + number * message.angle_step_rad
        print(f"{time_us / 1e6:8.2f} s  {channel}: {range_m:.2f} m at {degrees(angle_rad):.0f} deg")
