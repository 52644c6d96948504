"""The message of a component in the benchmark: a header, four doubles, sixteen covariances, and padding."""

import math
from collections.abc import Sequence
from typing import Any, Protocol


class Sample(Protocol):
    """Common fields of lcm-gen's class `sample_t` and the classes of peers with their own codec."""

    header: Any
    x_m: float
    y_m: float
    heading_rad: float
    confidence: float
    covariance: list[float]
    n_padding: int
    padding: bytes


def fill(made: Sample, component: int, tick: int, stage: int, read: Sequence[Sample | None], padding: bytes) -> None:
    """Fills a component's message with numbers that depend on all its inputs."""
    made.header.tick = made.header.sequence = tick
    made.header.time_us = tick * 10_000
    made.header.stage = stage
    made.header.writer = f"bench/c{component}"
    # the remainder, because the sums would grow for ever in the cycle of readers
    made.x_m = math.fmod(math.fsum(sample.x_m for sample in read if sample) + 1.0, 100.0)
    made.y_m = math.fmod(math.fsum(sample.y_m for sample in read if sample) - 1.0, 100.0)
    made.heading_rad = component * 0.01
    made.confidence = 0.5
    made.covariance = [0.01 * index for index in range(16)]
    made.n_padding = len(padding)
    made.padding = padding
