"""Robots that see a ball with the errors of a camera, and a tracker that follows it by their sightings."""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from procs.model.frames import rotation
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.sighting import Sighting

Floats = NDArray[np.float64]
PERIOD_S = 0.05
ROLLING_M_S2 = 0.4
ROLLING_NOISE_M2_S3 = 0.004
"""Spectral density of the accelerations that the filter expects of a rolling ball, rare hits included."""


class Eye:
    """A robot at a fixed pose that sees the ball like an omnidirectional camera."""

    def __init__(self, name: str, place_m: tuple[float, float], seed: int, recognised: float = 0.95) -> None:
        self.name = name
        self.place_m = np.array(place_m)
        self.rng = np.random.default_rng(seed)
        self.recognised = recognised
        self.last: Floats | None = None

    def look(self, ball_m: Floats, own: bool = False, age_s: float = 0.0) -> Sighting | None:
        """Returns a noisy sighting with its true covariance, or None at times."""
        ray = ball_m - self.place_m
        distance_m = float(np.hypot(*ray))
        turn = rotation(math.atan2(ray[1], ray[0]))
        deviations_m = np.array((0.01 + 0.005 * distance_m**2, 0.01 + 0.003 * distance_m))
        noise_m = deviations_m * self.rng.standard_normal(2)
        seen = self.rng.random() < self.recognised
        self.last = ball_m + turn @ noise_m
        covariance_m2 = turn @ np.diag(deviations_m**2) @ turn.T
        return Sighting(self.name, own, self.last, covariance_m2, age_s) if seen else None


def rolling(start_m: tuple[float, float], velocity_m_s: tuple[float, float], frames: int) -> Iterator[Floats]:
    """Returns true states (4) of a ball that rolls freely."""
    position, velocity = np.array(start_m), np.array(velocity_m_s)
    for _ in range(frames):
        speed = float(np.hypot(*velocity))
        slower = velocity * max(0.0, 1 - ROLLING_M_S2 * PERIOD_S / max(speed, 1e-9))
        position = position + (velocity + slower) / 2 * PERIOD_S
        velocity = slower
        yield np.concatenate((position, velocity))


def follow(eyes: list[Eye], states: Iterator[Floats]) -> Floats:
    """Returns errors (frames, 4) of a tracker that gets all sightings: of its own robot, and of others at 10 Hz."""
    tracker = BallTracker()
    errors = []
    for frame, state in enumerate(states):
        tracker.advance(PERIOD_S, 2.0)
        for number, eye in enumerate(eyes):
            sighting = eye.look(state[:2], own=number == 0)
            if sighting is not None and (number == 0 or frame % 2 == 0):
                tracker.see(sighting)
        errors.append(tracker.track.state - state if tracker.known else np.full(4, np.nan))
    return np.array(errors)


def rms(errors: Floats) -> float:
    return float(np.sqrt(np.nanmean(np.sum(errors**2, axis=1))))
