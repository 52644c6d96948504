"""Prints size and rate of the frames of each camera."""

from collections import Counter
from typing import Any

channels = ("*/image", "*/camera", "*/frame")
frames: Counter[str] = Counter()
began_us: dict[str, int] = {}


def message(channel: str, message: Any, time_us: int) -> None:
    frames[channel] += 1
    elapsed_us = time_us - began_us.setdefault(channel, time_us)
    if frames[channel] % 20 == 0 and elapsed_us:
        rate_hz = (frames[channel] - 1) * 1e6 / elapsed_us
        print(f"{channel}: frame {message.frame}, {message.width_px} x {message.height_px}, {rate_hz:.1f} Hz")
