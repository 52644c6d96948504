"""What a component writes in the benchmark: a header, four doubles, sixteen covariances, and padding."""

import math

from lcmtypes.bench import sample_t


def next_sample(component: int, tick: int, stage: int, read: list[sample_t], padding: bytes) -> sample_t:
    """What a component writes: numbers that depend on everything it read."""
    made = sample_t()
    made.header.tick = made.header.sequence = tick
    made.header.time_us = tick * 10_000
    made.header.stage = stage
    made.header.writer = f"bench/c{component}"
    made.x_m = math.fsum(sample.x_m for sample in read) + 1.0
    made.y_m = math.fsum(sample.y_m for sample in read) - 1.0
    made.heading_rad = component * 0.01
    made.confidence = 0.5
    made.covariance = [0.01 * index for index in range(16)]
    made.n_padding = len(padding)
    made.padding = padding
    # the sums would grow for ever round the ring of readers
    made.x_m, made.y_m = math.fmod(made.x_m, 100.0), math.fmod(made.y_m, 100.0)
    return made
